"""Dampers of other masses for the same machine and band: what more mass brings, and its costs."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from impact_damper.design.choose import coarse_comparison, compare, spread
from impact_damper.design.outcomes import Case, run
from impact_damper.design.screen import screen
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.performance.costs import measured_costs

# Masses divided by the nominal mass; frequencies of their reduced design, and starts
# of its two comparisons.
MASSES = (0.5, 0.7, 1.4, 2.0)
FREQUENCIES, COARSE_STARTS, STARTS = 5, 10, 24
# Forcing periods over which the force of a motion that is not periodic is measured.
WATCHED = 100


class Alternative(NamedTuple):
    """A damper of another mass.

    Attributes
    ----------
    task : Task
        With this mass.
    gap : float
        mm.
    worst : float
        Largest displacement over the band, the starts and the tolerated deviation of the gap, mm.
    share : float
        Least share of starts that end quiet at one of the frequencies and gaps.
    force : float
        Largest contact force of the largest motions at the nominal gap, N; NaN after an escape.
    """

    task: object
    gap: float
    worst: float
    share: float
    force: float


def alternatives(task, limit, *, workers=1, progress=None) -> list[Alternative]:
    """Return a reduced design for each mass of MASSES that is not above that of the machine."""
    found = []
    for factor in MASSES:
        mass = factor * task.mass
        if mass > task.machine.mass:
            continue
        other = replace(task, mass=mass, frequencies=FREQUENCIES, displacement_limit=1e-3 * limit)
        running = {"workers": workers, "progress": progress}
        screening = screen(other, **running)
        span = screening.gaps[0], screening.gaps[-1]
        frequency = screening.frequencies[screening.worst]
        coarse = coarse_comparison(other, span, frequency, limit, starts=COARSE_STARTS, **running)
        gap = coarse.choose(_tolerance(task)).gap
        found.append(judge(other, gap, limit, **running))
    return found


def judge(task, gap, limit, **running) -> Alternative:
    """Return a damper with its worst displacement and least share over the band and the tolerance.

    Parameters
    ----------
    task : Task
    gap, limit : float
        Gap and largest displacement of a quiet motion, mm.
    running
        `workers` and `progress` of `outcomes.run`.
    """
    gaps = gap * (1 + _tolerance(task) * np.array([-1, -0.5, 0, 0.5, 1]))
    few = spread(task.grid, FREQUENCIES)
    found = compare(task, np.unique(gaps), few, limit, STARTS, task.seed + 80, **running)
    least = found.numbers["start_quiet_share"].min()
    cases = [Case(1e-3 * gap, f) for f in few]
    records = run(task, cases, STARTS, task.seed + 81, settling=task.hurried, **running).random
    forces = [
        _largest_force(task, case, row[np.argmax(row["maximum_displacement"])])
        for case, row in zip(cases, records, strict=True)
    ]
    return Alternative(task, gap, float(found.worst.max()), float(least), max(forces))


def _largest_force(task, case, record):
    """Return the largest contact force of a motion, N."""
    if not np.isfinite(record["maximum_displacement"]):
        return np.nan
    p = task.packed(*case)
    periods = int(record["period"]) or WATCHED
    costs = measured_costs(p, record["state"].copy(), strobe_time(p), periods)
    return float(task.scales.to_si(costs["contact_force"], "force"))


def is_best(masses, costs) -> np.ndarray:
    """Return which of several dampers no other one betters: the Pareto front.

    Parameters
    ----------
    masses : array, shape (m,)
    costs : array, shape (m, k)
        Quantities to be small, such as worst displacement and contact force.

    Returns
    -------
    numpy.ndarray of bool, shape (m,)
    """
    table = np.column_stack([masses, costs])
    worse = [np.any(np.all(table <= row, axis=1) & np.any(table < row, axis=1)) for row in table]
    return ~np.array(worse)


def _tolerance(task):
    return task.tolerances.get("gap", 0.0)
