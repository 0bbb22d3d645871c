"""The first look at a design: the machine alone, and exact quiet orbits over gap and frequency.

A few motions give quiet orbits, and Newton's method follows these over the map. The smallest stable
one is then found exactly: its displacement has a derivative with respect to the gap by the
variational equations.
"""

import numpy as np
import xarray as xr
from scipy.optimize import brentq, root_scalar

from impact_damper.data.datasets import flag
from impact_damper.design.outcomes import Case, run
from impact_damper.design.task import LEAST_GAP, labelled, spread
from impact_damper.model.packed import CLEARANCE
from impact_damper.orbits.quiet_orbits import (
    dominant_root,
    find_quiet_orbit,
    is_symmetric_pair,
    quiet_orbits,
)
from impact_damper.orbits.sensitivity import sensitivity

# Largest gap of the map divided by the largest gap of rule (18) in the band, and number of gaps.
MOST_GAP, GAPS = 1.95, 40
# Gap in which the loose mass flies at constant speed between the walls, divided by the gap of rule
# (18), for a restitution near 1 (`theory.straight_flight`).
FLIGHT = 1.14
# First search for quiet orbits: random starts at each gap and frequency, gaps divided by the gap of
# straight flight, and number of frequencies.
SEEDED = 16
SEED_GAPS = (0.3, 0.5, 0.7, 0.9, 1.05)
SEED_FREQUENCIES = 5
# Shortest step with which an orbit is followed from one place of the map to the next one, as a
# fraction of their distance.
SHORTEST = 0.25
# Accuracy of the logarithms of gaps.
ACCURACY = 1e-10


def gap_span(task) -> tuple[float, float]:
    """Return the least and the greatest gap that a design considers, mm."""
    rules = [task.rule_gap(f) for f in task.grid]
    return 1e3 * LEAST_GAP * min(rules), 1e3 * MOST_GAP * max(rules)


def screen(task, progress=None) -> xr.Dataset:
    """Return the response without damper, the map of quiet orbits and the smallest stable one.

    The dataset also has `orbit_limit`, the provisional quiet limit.
    """
    gaps = np.geomspace(*gap_span(task), GAPS)
    parameters = np.array([[task.packed(1e-3 * gaps[0], f) for f in task.grid]] * GAPS)
    clearances = task.scales.from_si(1e-3 * gaps / 2, "clearance")
    parameters[..., CLEARANCE] = clearances[:, None]
    states, count = _seeds(task, gaps, progress)
    grid = quiet_orbits(parameters, states, shortest=SHORTEST)
    displacement, modulus = np.full((2, *grid.shape), np.nan)
    for cell, orbit in grid.orbits.items():
        displacement[cell] = task.millimetres(orbit.record["maximum_displacement"])
        modulus[cell] = abs(dominant_root(orbit))
    best = best_orbit(task, grid, np.where(modulus < 1, displacement, np.nan))
    values = {
        "balance_displacement": task.bare,
        "orbit_limit": _limit(task, best),
        "screened_displacement": displacement,
        "screened_modulus": modulus,
        "screen_motions": count,
        "screen_orbits": np.sum(np.isfinite(modulus)),
    }
    return labelled(values | best, frequency=task.grid, screened_gap=gaps)


def _seeds(task, gaps, progress):
    """Return states of quiet orbits on the map, NaN elsewhere, and the number of motions run."""
    worst = int(np.argmax(task.bare))
    rules = 1e3 * FLIGHT * np.array([task.rule_gap(f) for f in task.grid])
    columns = spread(np.arange(len(task.grid)), SEED_FREQUENCIES)
    cells = [
        (int(np.argmin(np.abs(gaps - share * rules[column]))), int(column))
        for column in np.union1d(columns, worst)
        for share in SEED_GAPS
    ]
    cases = [Case(1e-3 * gaps[row], task.grid[column]) for row, column in cells]
    running = {"settling": task.hurried, "progress": progress}
    found = run(task, cases, SEEDED, "screening", **running)
    states = np.full((GAPS, len(task.grid), 4), np.nan)
    for cell, records in zip(cells, found, strict=True):
        pairs = records[is_symmetric_pair(records)]
        if len(pairs):
            states[cell] = pairs["state"][np.argmin(pairs["maximum_displacement"])]
    return states, found.size


def _limit(task, best):
    """Return the provisional quiet limit, mm: the displacement limit of the task, if it has one.

    Otherwise it is the geometric mean of the displacements of the best orbit and of the machine
    without damper at the same frequency or, without an orbit, half of the latter.
    """
    if task.displacement_limit is not None:
        return 1e3 * task.displacement_limit
    if best["best_orbit_status"] == flag("best_orbit_status", "absent"):
        return float(task.bare.max() / 2)
    bare = task.bare[np.argmin(np.abs(task.grid - best["best_orbit_frequency"]))]
    return float(np.sqrt(bare * best["best_orbit_displacement"]))


def best_orbit(task, grid, stable) -> dict:
    """Return the smallest stable quiet orbit, as values of the variables `best_orbit_...`.

    It is searched for at the frequency with a stable quiet orbit at which the machine without
    damper moves most. `stable` are the displacements (mm) of the stable orbits of the map, NaN
    elsewhere.
    """
    known = np.isfinite(stable).any(axis=0)
    frequency = gap = size = np.nan
    status = "absent"
    if known.any():
        place = int(np.argmax(np.where(known, task.bare, 0)))
        row = int(np.nanargmin(stable[:, place]))
        column = _Column(grid, place)
        try:
            x, status = column.smallest(row)
        except ArithmeticError:
            x, status = column.x[row], "not_refined"
        frequency = float(task.grid[place])
        gap = 2e3 * task.scales.to_si(np.exp(x), "clearance")
        size = task.millimetres(column.at(x).maximum_displacement)
    return {
        "best_orbit_frequency": frequency,
        "best_orbit_gap": gap,
        "best_orbit_displacement": size,
        "best_orbit_status": flag("best_orbit_status", status),
    }


class _Column:
    """The quiet orbits at the frequency `place`, as functions of the logarithm x of the clearance.

    The rows of the map `grid` are gaps, and its columns frequencies.
    """

    def __init__(self, grid, place):
        self.x, self.found = np.log(grid.points[:, place, CLEARANCE]), {}
        self.orbits = {
            row: orbit for (row, column), orbit in grid.orbits.items() if column == place
        }

    def at(self, x):
        """Return the `Sensitivity` of the orbit at x, found from the nearest orbit of the map."""
        if x in self.found:
            return self.found[x]
        row = min(self.orbits, key=lambda each: abs(self.x[each] - x))
        orbit = self.orbits[row]
        if x != self.x[row]:
            p, slopes = orbit.p.copy(), self.at(self.x[row]).state_slopes
            p[CLEARANCE] = np.exp(x)
            guess = orbit.state + slopes[:, CLEARANCE] * (p[CLEARANCE] - orbit.p[CLEARANCE])
            orbit, status = find_quiet_orbit(p, guess)
            if orbit is None:
                raise ArithmeticError(f"no quiet orbit at the clearance {np.exp(x):g}: {status}")
        try:
            self.found[x] = sensitivity(orbit)
        except np.linalg.LinAlgError as error:
            raise ArithmeticError(f"fold at the clearance {np.exp(x):g}") from error
        return self.found[x]

    def slope(self, x):
        """Return the derivative of the largest displacement with respect to the clearance."""
        return self.at(x).displacement_slopes[CLEARANCE]

    def excess(self, x):
        """Return the modulus minus 1, and its derivative with respect to x."""
        found = self.at(x)
        return found.modulus - 1, found.modulus_slopes[CLEARANCE] * np.exp(x)

    def smallest(self, row):
        """Return the x of the smallest stable orbit near a row of the map, and a status.

        The row is that of the smallest stable orbit of the map.
        """
        here = self.x[row]
        step = 1 if self.slope(here) < 0 else -1
        if row + step not in self.orbits:
            return here, "range_ends"
        there = self.x[row + step]
        if self.slope(there) * step > 0:
            there = brentq(self.slope, here, there, xtol=ACCURACY)
            if self.at(there).modulus < 1:
                return there, "smooth" if self.at(there).displacement_smooth else "kink"
        elif self.at(there).modulus < 1:
            return here, "not_refined"
        return self.edge_between(here, there), "stability_ends"

    def edge_between(self, inside, outside):
        """Return the x at which the modulus reaches 1, between two values of x."""
        ends = sorted((inside, outside))
        (low, _), (high, _) = self.excess(ends[0]), self.excess(ends[1])
        guess = ends[0] + (ends[1] - ends[0]) * low / (low - high)
        found = root_scalar(self.excess, x0=guess, fprime=True, method="newton", xtol=ACCURACY)
        if found.converged and ends[0] <= found.root <= ends[1]:
            return float(found.root)
        # Newton's method fails if the modulus has a kink, where two multipliers meet.
        return brentq(lambda x: self.excess(x)[0], *ends, xtol=ACCURACY)
