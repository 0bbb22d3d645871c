"""Dampers of other masses for the same machine and band, with their displacements and forces.

A reduced design chooses the gap for each mass, with fewer frequencies, gaps and starts (initial
states) than the design of the damper itself.
"""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from impact_damper.design.compare import coarse_comparison, compare
from impact_damper.design.costs import measured_costs
from impact_damper.design.outcomes import Case, run
from impact_damper.design.screen import gap_span
from impact_damper.motions.strobe_map import strobe_time

# Masses divided by the nominal mass.
MASSES = (0.5, 0.7, 1.4, 2.0)
# Largest numbers in a reduced design.
# FREQUENCIES: frequencies of the band.
# GAPS, COARSE_STARTS: gaps, and starts at each gap and frequency, from which the gap is chosen.
# STARTS: starts at the chosen gap and at each frequency.
FREQUENCIES, GAPS, COARSE_STARTS, STARTS = 5, 20, 8, 24
# Cycles over which the contact force of a motion that is not periodic is measured.
WATCHED = 100


class Alternative(NamedTuple):
    """A damper of another mass.

    Attributes
    ----------
    task : Task
        The task with this mass.
    gap : float
        mm.
    worst : float
        Largest displacement over the band, the starts and the tolerated deviation of the gap, mm.
    share : float
        Share of starts that lead to quiet motions, at the worst frequency, and at the worst gap
        within the tolerance.
    force : float
        Largest contact force over the band at the nominal gap, N. At each frequency it is measured
        in the largest motion. NaN if a motion escapes.
    """

    task: object
    gap: float
    worst: float
    share: float
    force: float


def alternatives(task, limit, *, workers=1, progress=None) -> list[Alternative]:
    """Return a reduced design for each mass of MASSES up to the mass of the machine."""
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
    """Return the damper with a given gap as an `Alternative`.

    Parameters
    ----------
    task : Task
    gap, limit : float
        Gap and quiet limit, mm.
    **running
        Arguments `workers` and `progress` of `outcomes.run`.
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
    """Return the largest contact force of a motion, N, from its `records.MOTION`."""
    if not np.isfinite(record["maximum_displacement"]):
        return np.nan
    p = task.packed(*case)
    periods = int(record["period"]) or WATCHED
    costs = measured_costs(p, record["state"].copy(), strobe_time(p), periods)
    return float(task.scales.to_si(costs["contact_force"], "force"))


def is_best(masses, costs) -> np.ndarray:
    """Return which of several dampers are on the Pareto front.

    A damper is on the front unless another one is at most as heavy, has at most the same costs, and
    is lighter or better in one of the costs.

    Parameters
    ----------
    masses : array, shape (m,)
    costs : array, shape (m, k)
        Quantities that should be small, such as worst displacement and contact force. NaN where
        motions escape, which counts as worse than any number.

    Returns
    -------
    numpy.ndarray of bool, shape (m,)
    """
    table = np.column_stack([masses, np.where(np.isnan(costs), np.inf, costs)])
    worse = [np.any(np.all(table <= row, axis=1) & np.any(table < row, axis=1)) for row in table]
    return ~np.array(worse)


def _tolerance(task):
    return task.tolerances.get("gap", 0.0)
