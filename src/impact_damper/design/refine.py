"""The smallest stable quiet orbit over the gap, found exactly, and derivatives of its size.

The quiet orbit is the symmetric periodic motion for which a damper is designed. At each gap
Newton's method gives the orbit. The variational equations give the derivatives of its largest
displacement and of the modulus of its largest Floquet multiplier. The displacement is smallest
where its derivative with respect to the gap changes sign. If the modulus reaches 1 before, the
smallest stable orbit lies at this end of stability.

A map holds the quiet orbits at several gaps and frequencies. It serves as a first guess.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq, root_scalar

from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    DESIGN,
    INVERSE_MASS_RATIO,
    SIMPLE,
)
from impact_damper.orbits.quiet_orbits import find_quiet_orbit
from impact_damper.orbits.sensitivity import Sensitivity, sensitivity

# Accuracy of the logarithms of gaps.
ACCURACY = 1e-10
# Names of parameters of `packed.DESIGN` that are called differently for a machine in SI units.
SAID = {"cubic": "cubic_stiffness", "clearance": "gap", "mass_ratio": "mass"}


class BestOrbit(NamedTuple):
    """The smallest stable quiet orbit at one frequency, over the gap.

    Attributes
    ----------
    frequency : float
        Hz.
    gap, displacement, modulus : float
        Gap (mm), largest displacement (mm), and modulus of the largest Floquet multiplier; NaN if
        there is no such orbit.
    edge : float
        Smallest gap above `gap` at which the modulus reaches 1, mm; NaN if the modulus stays below
        1 in the map.
    status : str
        Value of the flag `best_orbit_status`. "smooth": the displacement has a smooth minimum over
        the gap. "kink": it has a minimum with a kink, because two peaks of the motion are equal
        there. "stability_ends": the orbit is smallest where it ceases to be stable. "range_ends":
        it is smallest at the first or last gap of the map with an orbit. "not_refined": the minimum
        could not be located between gaps of the map, and the numbers hold at a gap of the map.
        "absent": there is no stable orbit.
    """

    frequency: float
    gap: float
    displacement: float
    modulus: float
    edge: float
    status: str


NO_ORBIT = BestOrbit(np.nan, np.nan, np.nan, np.nan, np.nan, "absent")


def refine(task, grid, stable) -> BestOrbit:
    """Return the smallest stable quiet orbit of a map.

    It is searched for at one frequency. Among the frequencies with a stable quiet orbit, this is
    the one at which the machine without damper moves most.

    Parameters
    ----------
    task : Task
    grid : grid_following.Grid
        Quiet orbits over ascending gaps and the frequencies of the task.
    stable : array, shape (m, n)
        Largest displacements (mm) of the stable orbits, NaN elsewhere.
    """
    known = np.isfinite(stable).any(axis=0)
    if not known.any():
        return NO_ORBIT
    place = int(np.argmax(np.where(known, task.bare, 0)))
    row = int(np.nanargmin(stable[:, place]))
    column = _Column(grid, place)
    try:
        x, status = column.smallest(row)
    except ArithmeticError:
        x, status = column.x[row], "not_refined"
    found = column.at(x)
    gap, edge = 2e3 * task.scales.to_si(np.exp([x, column.edge_above(row)]), "clearance")
    size = task.millimetres(found.maximum_displacement)
    return BestOrbit(float(task.grid[place]), gap, size, found.modulus, edge, status)


class _Column:
    """The quiet orbits at one frequency, as functions of the logarithm x of the clearance.

    Parameters
    ----------
    grid : grid_following.Grid
        The map. Its rows are gaps, and its columns frequencies.
    place : int
        Index of the frequency.
    """

    def __init__(self, grid, place):
        self.x, self.found = np.log(grid.points[:, place, CLEARANCE]), {}
        self.orbits = {
            row: orbit for (row, column), orbit in grid.orbits.items() if column == place
        }

    def at(self, x) -> Sensitivity:
        """Return the orbit at x with its derivatives.

        The first guess of Newton's method is extrapolated linearly from the nearest orbit of the
        map.

        Raises
        ------
        ArithmeticError
            If no orbit is found, or if the orbit lies at a fold.
        """
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

        The row is that of the smallest stable orbit of the map. The status is that of `BestOrbit`.
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

    def edge_above(self, row):
        """Return the least x above a row of the map at which the modulus reaches 1, or NaN."""
        try:
            while self.at(self.x[row]).modulus < 1:
                row += 1
                if row not in self.orbits:
                    return np.nan
            return self.edge_between(self.x[row - 1], self.x[row])
        except ArithmeticError:
            return np.nan


class Dependence(NamedTuple):
    """Changes of an orbit, in per cent, if a parameter of machine or damper grows by 1 per cent.

    Attributes
    ----------
    names : list of str
        The parameters; "mass" is the mass of the damper.
    displacement, modulus : numpy.ndarray, shape (n,)
        Changes of the largest displacement and of the modulus of the largest multiplier. NaN
        without an orbit, or at a kink, which has no derivative.
    """

    names: list
    displacement: np.ndarray
    modulus: np.ndarray


def dependence(task, orbit) -> Dependence:
    """Return the exact relative derivatives of an orbit as a `Dependence`; NaN without an orbit."""
    names = [SAID.get(name, name) for name in DESIGN]
    missing = np.full(len(names), np.nan)
    if orbit is None:
        return Dependence(names, missing, missing)
    p, found = orbit.p, sensitivity(orbit)
    values = {name: p[place] for name, place in SIMPLE.items()} | {
        "restitution": task.restitution,
        "contact_stiffness": p[CONTACT_STIFFNESS],
        "mass_ratio": 1 / p[INVERSE_MASS_RATIO],
    }

    def relative(slopes, size, smooth):
        by_design = found.by_design(slopes)
        changes = np.array([by_design[name] * values[name] for name in DESIGN]) / size
        return changes if smooth else missing

    return Dependence(
        names,
        relative(found.displacement_slopes, found.maximum_displacement, found.displacement_smooth),
        relative(found.modulus_slopes, found.modulus, found.modulus_smooth),
    )
