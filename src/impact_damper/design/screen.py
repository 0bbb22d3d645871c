"""Screening, the first look at a design: the machine alone, rules for the gap, exact quiet orbits.

The quiet orbit is the symmetric periodic motion for which a damper is designed. The loose mass
presses each wall once in a forcing cycle. The screening answers each question with the cheapest
model. Harmonic balance gives the response without the damper. Rule (18) of the paper, stated in
`task`, gives the range of gaps. Two better rules are stored for comparison: the flight rule, in
which the loose mass flies at constant speed between the walls, and, for a linear machine, the slow
invariant manifold, a theory for small mass ratios. A few motions give quiet orbits, and Newton's
method follows these
orbits over gap and frequency. Motions from many starts (initial states) are run only later, by the
comparisons of gaps.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.design.outcomes import Case, run
from impact_damper.design.refine import BestOrbit, refine
from impact_damper.design.task import LEAST_GAP, spread
from impact_damper.model.packed import CLEARANCE
from impact_damper.orbits.quiet_orbits import dominant_root, is_symmetric_pair, quiet_orbits
from impact_damper.theory.straight_flight import light_mass_optimum

# The map holds the quiet orbits at several gaps and frequencies.
# MOST_GAP: largest gap, divided by the largest gap of rule (18) in the band.
# GAPS: number of gaps.
MOST_GAP, GAPS = 1.95, 40
# Gap of the flight rule divided by the gap of rule (18), for a restitution near 1
# (`theory.straight_flight`).
FLIGHT = 1.14
# First search for quiet orbits.
# SEEDED: number of random starts at each gap and frequency.
# SEED_GAPS: gaps, divided by the gap of the flight rule.
# SEED_FREQUENCIES: number of frequencies.
SEEDED = 16
SEED_GAPS = (0.3, 0.5, 0.7, 0.9, 1.05)
SEED_FREQUENCIES = 5
# Shortest step with which an orbit is followed from one place of the map to the next one, as a
# fraction of their distance.
SHORTEST = 0.25


class Screening(NamedTuple):
    """Result of the screening.

    Attributes
    ----------
    rule_gap, manifold_gap : float
        Gap by the flight rule at the frequency at which the machine without damper moves most, and
        gap by the slow invariant manifold at the resonance, mm. `manifold_gap` is NaN unless the
        spring is linear and contacts lose energy.
    gaps : numpy.ndarray, shape (m,)
        Gaps of the map of quiet orbits, mm.
    displacement, modulus : numpy.ndarray, shape (m, n)
        Largest displacement of the quiet orbit (mm), and modulus of its largest Floquet multiplier
        over half a period, at each gap and frequency of the task; NaN where no quiet orbit was
        found. The orbit is stable if the modulus is below 1.
    best : BestOrbit
        The smallest stable quiet orbit.
    limit : float
        Provisional quiet limit, mm: a motion with a smaller displacement is quiet.
    motions : int
        Number of motions that were run.
    """

    rule_gap: float
    manifold_gap: float
    gaps: np.ndarray
    displacement: np.ndarray
    modulus: np.ndarray
    best: BestOrbit
    limit: float
    motions: int


def gap_span(task) -> tuple[float, float]:
    """Return the least and the greatest gap that a design considers, mm."""
    rules = [task.rule_gap(f) for f in task.grid]
    return 1e3 * LEAST_GAP * min(rules), 1e3 * MOST_GAP * max(rules)


def screen(task, *, workers=1, progress=None) -> Screening:
    """Return the result of the screening of a task.

    Parameters
    ----------
    task : Task
    workers, progress
        As in `ensemble.settle`.

    Returns
    -------
    Screening
    """
    frequencies, gaps = task.grid, np.geomspace(*gap_span(task), GAPS)
    worst = int(np.argmax(task.bare))
    parameters = np.array([[task.packed(1e-3 * gaps[0], f) for f in frequencies]] * GAPS)
    clearances = task.scales.from_si(1e-3 * gaps / 2, "clearance")
    parameters[..., CLEARANCE] = clearances[:, None]
    rules = 1e3 * FLIGHT * np.array([task.rule_gap(f) for f in frequencies])
    columns = spread(np.arange(len(frequencies)), SEED_FREQUENCIES)
    cells = [
        (int(np.argmin(np.abs(gaps - share * rules[column]))), int(column))
        for column in np.union1d(columns, worst)
        for share in SEED_GAPS
    ]
    cases = [Case(1e-3 * gaps[row], frequencies[column]) for row, column in cells]
    running = {"settling": task.hurried, "workers": workers, "progress": progress}
    found = run(task, cases, SEEDED, "screening", **running)
    states = np.full((*parameters.shape[:2], 4), np.nan)
    for cell, records in zip(cells, found, strict=True):
        pairs = records[is_symmetric_pair(records)]
        if len(pairs):
            states[cell] = pairs["state"][np.argmin(pairs["maximum_displacement"])]
    grid = quiet_orbits(parameters, states, shortest=SHORTEST)
    displacement, modulus = np.full((2, *grid.shape), np.nan)
    for cell, orbit in grid.orbits.items():
        displacement[cell] = task.millimetres(orbit.record["maximum_displacement"])
        modulus[cell] = abs(dominant_root(orbit))
    best = refine(task, grid, np.where(modulus < 1, displacement, np.nan))
    return Screening(
        rules[worst],
        1e3 * _manifold_gap(task),
        gaps,
        displacement,
        modulus,
        best,
        _limit(task, best),
        found.size,
    )


def _limit(task, best):
    """Return the provisional quiet limit, mm: the displacement limit of the task, if it has one.

    Otherwise the limit is the geometric mean of two displacements: that of the best orbit, and that
    of the machine without damper at the same frequency. On a logarithmic scale a quiet motion is
    nearer to the orbit. Without an orbit the limit is half of the displacement without damper.
    """
    if task.displacement_limit is not None:
        return 1e3 * task.displacement_limit
    if best.status == "absent":
        return float(task.bare.max() / 2)
    bare = task.bare[np.argmin(np.abs(task.grid - best.frequency))]
    return float(np.sqrt(bare * best.displacement))


def _manifold_gap(task):
    """Return the gap (m) with the smallest response at the natural frequency, or NaN.

    It follows from the slow invariant manifold (`theory.straight_flight`).
    """
    machine = task.machine
    if machine.cubic_stiffness or not machine.linear_stiffness or task.restitution == 1:
        return np.nan
    oscillator, damper, frequency = task.system(1e-3, machine.natural_frequency)
    damping_ratio = oscillator.damping / (2 * oscillator.linear_frequency)
    best = light_mass_optimum(damper.mass_ratio, task.restitution, damping_ratio)
    static = oscillator.forcing_amplitude(frequency) / oscillator.linear_frequency**2
    return 2 * task.scales.to_si(best * static, "displacement")
