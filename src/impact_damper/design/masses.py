"""Dampers of other masses for the same machine and band: what more mass brings, and what it costs."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from impact_damper.design.choose import coarse_comparison, compare
from impact_damper.design.deviations import spread
from impact_damper.design.screen import screen

# Masses divided by the nominal mass; frequencies and starts of their reduced design.
MASSES = (0.5, 0.7, 1.4, 2.0)
FREQUENCIES, STARTS = 5, 32


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
    """

    task: object
    gap: float
    worst: float
    share: float


def alternatives(task, limit, *, workers=1, progress=None) -> list[Alternative]:
    """Return a reduced design for each mass of MASSES that is not above that of the machine."""
    found = []
    for factor in MASSES:
        mass = factor * task.mass
        if mass > task.machine.mass:
            continue
        other = replace(
            task, mass=mass, frequencies=FREQUENCIES, displacement_limit=1e-3 * limit
        )
        running = {"workers": workers, "progress": progress}
        screening = screen(other, **running)
        gap = coarse_comparison(other, screening, **running).choose(_tolerance(task)).gap
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
    return Alternative(task, gap, float(found.worst.max()), float(least))


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
    worse = [
        np.any(np.all(table <= row, axis=1) & np.any(table < row, axis=1)) for row in table
    ]
    return ~np.array(worse)


def _tolerance(task):
    return task.tolerances.get("gap", 0.0)
