"""Designs of machines drawn at random, with their promises checked by another program.

The table has for each machine the decision of the design, the share of new starts that exceed the
promise, and the promised displacement of the best of 40 gaps, swept without search. Boost.odeint
(`rivals/odeint.cpp`), which shares no code with the library, runs the new starts: at the gap, at
both ends of the gap's tolerance, and between frequencies of the grid. Dampers with gravity,
friction or a moving base are run by a C program (`tests/references/built.c`).
"""

import math
import time
from pathlib import Path

import numpy as np
import pandas as pd
from references.built import by_program
from scipy.stats import binom

import impact_damper as idm
from benchmarks.rivals import odeint_runs
from impact_damper.data.datasets import decode
from impact_damper.design.cells import Cell, run
from impact_damper.design.confirm import find_gap
from impact_damper.design.promise import Promise, factor_sets, other_sets
from impact_damper.design.task import Task
from impact_damper.motions.start_states import random_starts

HARDENING = {"mass": 20, "linear_stiffness": 1.5e5, "cubic_stiffness": 8e8, "damping_ratio": 0.004,
             "force": 60}  # fmt: skip
BOARD = {"mass": 0.35, "linear_stiffness": 4.477e5, "damping_ratio": 0.01111,
         "base_acceleration": 3 * 9.80665}  # fmt: skip
PUMP = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005, "force": 40}
# Machines that were designed wrongly before version 0.2: machine, and arguments of design_damper.
KNOWN = {
    "hardening, wide": (HARDENING, {"mass": 1.2, "restitution": 0.8, "contact": 1e7,
        "band": (16, 20), "tolerances": {"gap": 0.05, "restitution": 0.1}}),
    "hardening, narrow": (HARDENING, {"mass": 1.2, "restitution": 0.8, "contact": 1e7,
        "band": (17.5, 18.5), "tolerances": {"gap": 0.05, "restitution": 0.1},
        "displacement_limit": 3e-3}),
    "board": (BOARD, {"mass": 0.015, "restitution": 0.7, "contact": 1e7, "band": (165, 195),
        "displacement_limit": 0.52e-3}),
    "pump": (PUMP, {"mass": 1.2, "restitution": 0.6, "contact": 2e7, "band": (20, 21)}),
    "pump, light": (PUMP, {"mass": 0.6, "restitution": 0.7, "contact": 2e7, "band": (20.3, 20.8),
        "tolerances": {"gap": 0.02}}),
}  # fmt: skip
# Dampers as they are built: vertical with friction, inclined, and on a moving base.
AS_BUILT = {"mass": 1.2, "restitution": 0.6, "contact": 1e6, "band": (20, 21),
            "tolerances": {"gap": 0.05}}  # fmt: skip
BUILT = {
    "vertical, friction": (PUMP, AS_BUILT | {"mount": {"inclination": "90 deg",
        "friction_coefficient": 0.1, "normal_force": 2}}),
    "inclined": (PUMP, AS_BUILT | {"mount": {"inclination": "30 deg",
        "friction_coefficient": 0.05}}),
    "hardening, on a base": ({"mass": 12, "linear_stiffness": 2e5, "cubic_stiffness": 5e8,
        "damping_ratio": 0.01, "base_displacement": 2e-4}, AS_BUILT | {"band": (20, 22)}),
}  # fmt: skip
EXCITATIONS = ("force", "base_displacement", "unbalance")
# STARTS is the number of new starts in each of four cells, FEWER for drawn machines and for dampers
# as they are built. CYCLES are forcing cycles of a run. The first LEAD cycles are left out: the
# promise holds after transients, which last up to a thousand cycles.
STARTS, FEWER, CYCLES, LEAD = 400, 100, 1500, 1000
TOLERANCE = 1e-8  # of the other program
# Numbers of gaps, frequencies and starts of the sweep. 59 starts are the fewest that bound 95 %.
GAPS, FREQUENCIES, SWEPT = 40, 7, 59
# A gap of the sweep counts as better than the design if its displacement is less by this share.
BETTER, CLOSE = 0.1, 0.02
HOW = (
    f"New starts: {STARTS}, or {FEWER} of drawn machines and of dampers as they are built, in each "
    "of four cells (the gap and both ends of its tolerance at the "
    "worst frequency, and a frequency between points of the grid), in runs of "
    f"{CYCLES} cycles, the first {LEAD} left out, with a tolerance of {TOLERANCE:g}. "
    "`exceeded_share` is the largest share of starts that exceed the promise; 5 % are allowed. A "
    "promise is broken if as many exceed it "
    f"with a probability below 0.001. The sweep has {GAPS} gaps, {FREQUENCIES} frequencies and "
    f"{SWEPT} starts; gaps that seem better by {BETTER:.0%} are computed as the design was."
)
RULE = 8 * "|---" + "|\n"  # below the head of the table in the documentation
# A promise is broken if, at 5 % for each start, so many starts exceed it with a lower probability.
CHANCE = 1e-3


def drawn(number) -> tuple:
    """Return a machine and arguments of a design, drawn at random with the seed `number`."""
    random = np.random.default_rng([1995, number])
    mass, frequency = 10 ** random.uniform(-1, 3), 10 ** random.uniform(0.5, 2.3)
    stiffness = mass * (2 * math.pi * frequency) ** 2
    damping = 10 ** random.uniform(math.log10(0.002), math.log10(0.03))
    machine = {"mass": mass, "linear_stiffness": stiffness, "damping_ratio": damping}
    static = 10 ** random.uniform(-4.5, -3)  # static deflection, m
    excitation = EXCITATIONS[random.integers(3)]
    size = {"force": stiffness * static, "base_displacement": static, "unbalance": mass * static}
    machine[excitation] = size[excitation]
    resonance = static / (2 * damping)
    # The spring's frequency changes by the share `shift` at the displacement without the damper.
    shift = random.choice([0.0, random.uniform(0.02, 0.2), -random.uniform(0.01, 0.04)])
    machine["cubic_stiffness"] = 8 / 3 * stiffness * shift / resonance**2
    middle = frequency * (1 + max(0, shift))
    width = random.uniform(0.02, 0.2)
    ratio = random.uniform(0.02, 0.12)
    asked = {
        "mass": ratio * mass,
        "restitution": random.uniform(0.4, 0.9),
        "contact": stiffness * 10 ** random.uniform(2, 3),
        "band": (middle * (1 - width / 2), middle * (1 + width / 2)),
        "tolerances": {"gap": random.choice([0.05, 0.1, 0.2])},
    }
    if random.random() < 0.5:
        asked["displacement_limit"] = resonance * random.uniform(0.1, 0.6)
    return machine, asked


def cells_of(task, design) -> list:
    """Return four cells: the gap, both ends of its tolerance, and a frequency beside the grid."""
    gap, worst = 1e-3 * float(design["design_gap"]), float(design["promised_frequency"])
    sets = design["promise_factor"].values
    between = task.grid[:-1] + np.diff(task.grid) / 2
    between = between[np.argmin(np.abs(between - worst))]
    harmful = sets[int(design["promised_set"])]
    ends = np.array([harmful, harmful])
    ends[:, 0] = sets[:, 0].min(), sets[:, 0].max()
    conditions = [(worst, sets[0]), (between, harmful), *((worst, each) for each in ends)]
    return [Cell(gap, frequency, tuple(factors)) for frequency, factors in conditions]


def new_sizes(task, cell, count, number, lead=LEAD, tolerance=TOLERANCE) -> np.ndarray:
    """Return the largest displacements (mm) of new starts by Boost.odeint, from `lead` cycles on.

    The seed of the starts is [2026, `number`].
    """
    system = task.system(*cell)
    states, _ = random_starts(*system, count, [2026, number], task.effort.settling)
    if task.gravity or task.friction or system[0].base:
        return _by_program(task, cell, states, lead)
    period = 2 * math.pi / system[2]
    given = 0.0, lead * period, CYCLES * period, tolerance
    return task.millimetres(odeint_runs.largest(task.packed(*cell), states, *given))


def _by_program(task, cell, states, lead):
    """Return the largest displacements (mm) from scaled states by the C program."""
    units = [task.scales.to_si(1.0, kind) for kind in ("displacement", "velocity")] * 2
    damper = task.damper(cell.gap, cell.factors)
    given = task.machine, damper, cell.frequency
    runs = [by_program(*given, state, CYCLES, lead) for state in states * units]
    return 1e3 * np.array(runs)


def exceeded(task, design, count) -> list:
    """Return the shares of new starts that exceed the promise in four cells."""
    promised = float(design["promised_displacement"])
    return [
        np.mean(~(new_sizes(task, cell, count, number) <= promised))
        for number, cell in enumerate(cells_of(task, design))
    ]


def swept(task) -> tuple:
    """Return many gaps (mm), and their displacements (mm), from GAPS gaps with SWEPT starts.

    The displacement of a gap is the largest within the tolerances, interpolated between the gaps.
    """
    gaps = np.geomspace(*task.gap_span, GAPS)
    frequencies = task.few(FREQUENCIES)
    others = other_sets(task, gaps[0])
    cells = [Cell(1e-3 * g, f, tuple(o)) for g in gaps for f in frequencies for o in others]
    sizes = task.millimetres(run(task, cells, SWEPT, ("masses", 7)).peaks.max(axis=1))
    sizes = sizes.reshape(GAPS, -1).max(axis=1)
    fine = np.geomspace(gaps[0], gaps[-1], 2000)
    values = np.interp(np.log(fine), np.log(gaps), np.minimum(sizes, 1e9))
    low, high = task.gap_ends(fine)
    pairs = zip(low, high, strict=True)
    within = np.array([values[(fine >= a) & (fine <= b)].max() for a, b in pairs])
    inside = (low >= gaps[0]) & (high <= gaps[-1])
    return fine[inside], within[inside]


def best_swept(task, promised) -> tuple:
    """Return the best gap of a sweep (mm), and its displacement (mm).

    Each gap that seems better than BETTER is computed as the design was, the best one first, until
    one of them is better or none is left. Gaps closer than CLOSE to a gap computed count as it.
    """
    gaps, sizes = swept(task)
    sizes = sizes.copy()
    for _ in range(GAPS):
        k = int(np.argmin(sizes))
        if sizes[k] >= (1 - BETTER) * promised:
            break
        found = confirmed(task, gaps[k])
        if found < (1 - BETTER) * promised:
            return gaps[k], found
        sizes[np.abs(np.log(gaps / gaps[k])) < CLOSE] = found
    k = int(np.argmin(sizes))
    return gaps[k], sizes[k]


def confirmed(task, gap) -> float:
    """Return the promised displacement (mm) of a gap (mm), with all starts and frequencies."""
    return Promise(task, 1e-3 * gap, factor_sets(task, gap), ("masses", 8)).refined().size


def row(name, machine, asked, workers) -> dict:
    """Return the row of one machine."""
    task = Task(machine=idm.Machine(**machine), **asked, effort=idm.Effort(workers=workers))
    begin = time.process_time()
    design = find_gap(task)
    seconds = time.process_time() - begin
    promised = float(design["promised_displacement"])
    count = STARTS if name in KNOWN else FEWER
    shares = exceeded(task, design, count)
    gap, best = best_swept(task, promised)
    chances = binom.sf(count * np.array([*shares, 0.0]) - 1, count, 0.05)
    found = {
        "machine": name,
        "bare_mm": float(design["largest_bare_displacement"]),
        "decision": decode(design["decision"]).item(),
        "gap_mm": float(design["design_gap"]),
        "promised_mm": promised,
        "record": decode(design["record_status"]).item(),
        "exceeded_share": max(shares),
        "promise": "holds" if chances.min() >= CHANCE else "broken",
        "swept_gap_mm": gap,
        "swept_mm": best,
        "as_good": "yes" if best >= (1 - BETTER) * promised else "no",
        "cpu_seconds": seconds,
    }
    print("  " + ", ".join(f"{k} {v}" for k, v in found.items()), flush=True)
    return found


def table(count, workers=1) -> pd.DataFrame:
    """Return a row for each machine in KNOWN and BUILT, and for `count` drawn machines."""
    made = KNOWN | BUILT | {f"random {k}": drawn(k) for k in range(count)}
    return pd.DataFrame([row(name, *each, workers) for name, each in made.items()])


def with_table(text, found) -> str:
    """Return the text of docs/explanation/promise.md with the rows of a table of this module."""
    words = {"build": "build", "do_not_build": "do not build"}
    rows = [
        f"| {each.machine} | {each.bare_mm:.3g} | {words[each.decision]} | {each.gap_mm:.3g} | "
        f"{each.promised_mm:.3g} | {100 * each.exceeded_share:.2g} | {each.swept_mm:.3g} at "
        f"{each.swept_gap_mm:.3g} | {each.cpu_seconds:.0f} |"
        for each in found.itertuples()
    ]
    head, _ = text.split(RULE)  # the table ends the page
    return head + RULE + "\n".join(rows) + "\n"


if __name__ == "__main__":
    page, kept = Path("docs/explanation/promise.md"), Path("results/benchmarks/promises.csv")
    page.write_text(with_table(page.read_text(), pd.read_csv(kept)))
