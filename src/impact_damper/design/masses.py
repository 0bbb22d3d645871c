"""Dampers of other masses for the same machine and band: what more mass brings, and its costs."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from impact_damper.design.compare import coarse_comparison, compare
from impact_damper.design.outcomes import Case, run
from impact_damper.design.screen import gap_span
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.performance.costs import measured_costs

# Masses divided by the nominal mass; most frequencies of their reduced design, gaps and starts of
# its coarse comparison, and most starts of its last one.
MASSES = (0.5, 0.7, 1.4, 2.0)
FREQUENCIES, GAPS, COARSE_STARTS, STARTS = 5, 20, 8, 24
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
        frequencies = min(FREQUENCIES, task.frequencies)
        other = replace(task, mass=mass, frequencies=frequencies, displacement_limit=1e-3 * limit)
        running = {"workers": workers, "progress": progress}
        fewer = {"most": GAPS, "starts": COARSE_STARTS}
        coarse = coarse_comparison(other, gap_span(other), limit, **fewer, **running)
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
    few = task.few(FREQUENCIES)
    starts = min(STARTS, task.starts)
    found = compare(task, np.unique(gaps), few, limit, starts, "masses", **running)
    cases = [Case(1e-3 * gap, f) for f in few]
    records = run(task, cases, starts, "masses", settling=task.hurried, **running)
    forces = [
        _largest_force(task, case, row[np.argmax(row["maximum_displacement"])])
        for case, row in zip(cases, records, strict=True)
    ]
    least = float(found.least_share.min())
    return Alternative(task, gap, float(found.worst.max()), least, float(np.max(forces)))


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
        Quantities to be small, such as worst displacement and contact force; NaN where one is not
        known because motions escape, which is worse than any number.

    Returns
    -------
    numpy.ndarray of bool, shape (m,)
    """
    table = np.column_stack([masses, np.where(np.isnan(costs), np.inf, costs)])
    worse = [np.any(np.all(table <= row, axis=1) & np.any(table < row, axis=1)) for row in table]
    return ~np.array(worse)


def _tolerance(task):
    return task.tolerances.get("gap", 0.0)
