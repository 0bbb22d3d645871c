"""The best absorber for a machine with a cubic spring at its own force, by direct search.

For a cubic spring the closed forms are approximations, and without linear stiffness there is none.
The search minimises the largest displacement over a band, by choice of stiffness, damping and cubic
stiffness. It takes displacements from the balance of one harmonic, of all solutions, stable or not.
This is quick but misses motions without a period, so that the absorber must be judged by its exact
motions afterwards.
"""

from itertools import product

import numpy as np
from scipy.optimize import minimize

from impact_damper.absorbers.absorber import TunedAbsorber, check_mass
from impact_damper.absorbers.problems import problems_of
from impact_damper.absorbers.seeds import harmonic_displacements
from impact_damper.absorbers.tuning import check_band, exact_absorber
from impact_damper.literature.nonlinear_absorber import tuned_cubic
from impact_damper.motions.smooth_runs import (
    INVERSE_MASS,
    LINK_CUBIC,
    LINK_DAMPING,
    LINK_STIFFNESS,
)

# Grid of the search: natural frequency of the absorber, from LOWEST times the lowest frequency of
# the band to its highest; ratio of the damping to 2 m w at the middle of the band; ratio of the
# cubic stiffness to `tuned_cubic`. A second grid combines the exact absorber with each cubic
# stiffness. Numbers of forcing frequencies: COARSE on the grids, FINE where their best are refined.
TUNINGS, LOWEST = 16, 0.3
DAMPINGS = np.geomspace(0.03, 0.5, 5)
CUBICS = (0.01, 0.3, 1.0, 3.0, 10.0)
COARSE, FINE = 25, 45
# With MARGIN times the machine's force the largest displacement may be up to MOST_RISE times as
# large. If it is larger, a detached resonance is near. The balance of one harmonic predicts the
# force of its onset with an error of some per cent, so that then the larger displacement counts.
MARGIN, MOST_RISE = 1.1, 1.3
# Number of points of each grid that are refined, and tolerance of the logarithms of the unknowns.
REFINED = 2
TOLERANCE = 2e-3


def best_absorber(machine, mass, band) -> TunedAbsorber:
    """Return the absorber with the least largest displacement over a band at the machine's force.

    Parameters
    ----------
    machine : Machine
        With a cubic stiffness.
    mass : float, str or pint.Quantity
        kg.
    band : sequence of 2 floats
        Lowest and highest forcing frequency, Hz.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range, or the machine's spring is linear: `exact_absorber` is
        exact then.
    """
    mass = check_mass(machine, mass)
    if machine.cubic_stiffness == 0:
        raise ValueError(
            "cubic_stiffness = 0 N/m^3: must not be 0 for a direct search (with a linear spring of "
            "the machine exact_absorber is exact)"
        )
    low, high = check_band(machine, band)
    unit = _unit(machine, mass, (low * high) ** 0.5)

    def worst(logarithms, count):
        absorbers = np.exp(logarithms) * unit
        sizes = _largest(machine, mass, absorbers, np.linspace(low, high, count), 1.0)
        more = _largest(machine, mass, absorbers, np.linspace(low, high, COARSE), MARGIN)
        return np.log(np.where(more > MOST_RISE * sizes, more, sizes))

    own = np.geomspace(LOWEST * low, high, TUNINGS)
    grids = [product((own / (low * high) ** 0.5) ** 2, DAMPINGS, CUBICS)]
    if machine.linear_stiffness:
        tuned = exact_absorber(machine, mass)
        grids.append(product([tuned.stiffness / unit[0]], [tuned.damping / unit[1]], CUBICS))
    starts = []
    for grid in grids:
        points = np.log(list(grid))
        starts.extend(points[np.argsort(worst(points, COARSE))[:REFINED]])
    found = [
        minimize(
            lambda values: worst(values[None], FINE)[0],
            start,
            method="Nelder-Mead",
            options={"xatol": TOLERANCE, "fatol": TOLERANCE},
        )
        for start in starts
    ]
    best = np.exp(min(found, key=lambda each: each.fun).x) * unit
    names = "stiffness", "damping", "cubic_stiffness"
    return TunedAbsorber(mass=mass, **dict(zip(names, map(float, best), strict=True)))


def _unit(machine, mass, frequency):
    """Return the units of stiffness, damping and cubic stiffness in the search, in SI units."""
    w = 2 * np.pi * frequency
    cubic = tuned_cubic(mass / machine.mass, machine.cubic_stiffness)
    return np.array([mass * w**2, 2 * mass * w, cubic])


def _largest(machine, mass, absorbers, frequencies, share):
    """Return the largest displacement of each absorber (rows of SI values), dimensionless."""
    scales = machine.scales
    bare = problems_of(machine, None, frequencies, [share])
    w = scales.from_si(frequencies, "frequency")
    problems = np.tile(bare, (len(absorbers), 1))
    problems[:, INVERSE_MASS] = 1 / scales.from_si(mass, "mass")
    columns = {
        LINK_STIFFNESS: ("stiffness", w**2),
        LINK_DAMPING: ("damping", w),
        LINK_CUBIC: ("cubic_stiffness", w**2),
    }
    for values, (column, (quantity, power)) in zip(absorbers.T, columns.items(), strict=True):
        problems[:, column] = np.divide.outer(scales.from_si(values, quantity), power).ravel()
    return harmonic_displacements(problems).reshape(len(absorbers), -1).max(axis=1)
