"""Time that the kernel takes for a forcing cycle, over amplitude, contacts and tolerance.

The kernel is the package's compiled integrator. In this module and its tables a period is a forcing
cycle, and a scene is a motion with its initial state.
"""

import math
from functools import partial

import numpy as np
import pandas as pd

from benchmarks.methods import TIMED
from benchmarks.scenes import BenchmarkScene
from benchmarks.timing import interleaved
from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.records import measured
from impact_damper.motions.simulate import random_states
from impact_damper.plot import style

OSCILLATOR = Oscillator(0.215)
DAMPER = Damper(0.12, 2.0)
TOLERANCES = (1e-6, 1e-9, 1e-12)
# Numbers of forcing cycles. PERIODS are timed, TRANSIENT are run before.
PERIODS, TRANSIENT = 20, 30
# Radius of the ball of random starts.
RADIUS = 2.0


def motion(damper, frequency, start):
    """Return a scene after a transient, its contacts in a cycle and its largest |Z1|.

    The field `exact` of the scene holds the kernel's own state, since only times are measured here.
    """
    p = pack(OSCILLATOR, damper, frequency)
    period = 2 * math.pi / frequency
    begin, y = 0.5 * math.pi / frequency, np.array(start)
    none, work = np.empty((0, 4)), workspace()
    advance(p, y, none, side_of(p, y), begin, begin + TRANSIENT * period, 1e-9, work)
    end, last = begin + PERIODS * period, y.copy()
    _, contacts, _ = advance(p, last, none, side_of(p, last), begin, end, 1e-9, work)
    size = float(measured(p, y.copy(), PERIODS, 1e-9)["maximum_displacement"])
    return (
        BenchmarkScene("motion", p, begin, end, PERIODS, y[None], last[None]),
        contacts / PERIODS,
        size,
    )


def motions(count, seed=1995):
    """Return motions with and without the damper, with random frequencies and starts."""
    random = np.random.default_rng(seed)
    found = []
    for damper in (None, DAMPER):
        frequencies = random.uniform(0.8, 2.4, count)
        for i, frequency in enumerate(frequencies):
            start = random_states(1, RADIUS, damper or DAMPER, seed + i)[0]
            if damper is None:
                # This start leads to the resonance motion, if that motion exists at `frequency`.
                start[:2] = 1.4 * frequency * np.array([0.9, -0.5])
            found.append(motion(damper, frequency, start))
    return found


def per_period(found, rounds, tolerances=TOLERANCES):
    """Return the microseconds that a forcing cycle of each of `motions` takes, by tolerance."""
    rows = []
    for scene, contacts, size in found:
        runs = {each: TIMED["kernel"].prepare(scene, each) for each in tolerances}
        calls = {each: partial(run, scene.starts) for each, run in runs.items()}
        for tolerance, seconds in interleaved(calls, rounds).items():
            rows.append({
                "frequency": scene.parameters[FREQUENCY], "contacts": contacts,
                "displacement": size, "tolerance": tolerance,
                "median_us": 1e6 * np.median(seconds) / PERIODS,
            })  # fmt: skip
    return pd.DataFrame(rows)


def fitted(table):
    """Return the fit of time = a + b contacts + c (2 pi/W) max |Z1|, in microseconds per cycle.

    `table` is the result of `per_period`. The last term stands for the number of steps in flight:
    the length of a step is proportional to the radius of convergence of the Taylor series, which is
    inversely proportional to the largest |Z1|.
    """
    rows = []
    for tolerance, of in table.groupby("tolerance", sort=False):
        turns = 2 * math.pi / of["frequency"] * of["displacement"]
        columns = np.stack([np.ones(len(of)), of["contacts"], turns], axis=1)
        found, *_ = np.linalg.lstsq(columns, of["median_us"], rcond=None)
        rest = of["median_us"] - columns @ found
        rows.append({
            "tolerance": tolerance, "constant_us": found[0], "contact_us": found[1],
            "displacement_us": found[2], "rms_of_rest_us": math.sqrt(np.mean(rest**2)),
        })  # fmt: skip
    return pd.DataFrame(rows)


@style.context()
def draw(table):
    """Draw the time of a cycle: without contacts over (2 pi/W) max |Z1|, else over contacts."""
    table = table.assign(turns=2 * math.pi / table["frequency"] * table["displacement"])
    drawn = style.figure("double", 3.2)
    left, right = drawn.subplots(1, 2, sharey=True)
    free = table[table["contacts"] == 0]
    damped = table[table["contacts"] > 0]
    for i, tolerance in enumerate(sorted(set(table["tolerance"]), reverse=True)):
        label = f"tolerance $10^{{{round(math.log10(tolerance))}}}$"
        for axes, of, across in ((left, free, "turns"), (right, damped, "contacts")):
            of = of[of["tolerance"] == tolerance]
            axes.plot(
                of[across], of["median_us"], label=label, **style.points(i) | {"markersize": 3}
            )
            trend = np.polynomial.Polynomial.fit(of[across], of["median_us"], 1)
            axes.plot(*trend.linspace(2), **style.curve(i))
    left.set(
        xlabel=r"Largest displacement times period, $2\pi\,\max\,|Z_1|/\Omega$", ylim=(0, None)
    )
    left.set_ylabel("Time per forcing cycle (µs)")
    right.set_xlabel("Contacts per cycle")
    style.letter_panels([left, right])
    style.legend(drawn, 3)
    return drawn
