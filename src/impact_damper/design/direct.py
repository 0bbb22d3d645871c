"""The best absorber for a machine with a cubic spring at the machine's own force, by direct search.

For a cubic spring the closed forms of `tuning` are approximations, and without linear stiffness
there is no closed form. The search chooses stiffness, damping and cubic stiffness of the absorber
to minimise the largest displacement over a band. It takes the displacements from all solutions,
stable or unstable, of single-term harmonic balance. This is quick, but it misses motions that are
not periodic. Therefore the absorber must be judged by its exact motions afterwards.
"""

from itertools import product

import numpy as np
from scipy.optimize import minimize

from impact_damper.design.absorber import TunedAbsorber, check_mass
from impact_damper.design.absorber_problems import problems_of
from impact_damper.design.absorber_seeds import harmonic_displacements
from impact_damper.design.smooth_runs import INVERSE_MASS, LINK_CUBIC, LINK_DAMPING, LINK_STIFFNESS
from impact_damper.design.tuning import check_band, exact_absorber
from impact_damper.theory.nonlinear_absorber import tuned_cubic

# First grid of the search:
# TUNINGS   number of natural frequencies of the absorber, which go from LOWEST times the lowest
#           frequency of the band to its highest frequency
# DAMPINGS  ratios of the damping to 2 m w, with the mass m of the absorber and the geometric mean w
#           of the ends of the band
# CUBICS    ratios of the cubic stiffness to `tuned_cubic`
# If the machine has a linear stiffness, a second grid combines the stiffness and damping that are
# best for a linear spring (`exact_absorber`) with each of CUBICS.
# COARSE    number of forcing frequencies on both grids
# FINE      number of forcing frequencies in the refinement of the best grid points
TUNINGS, LOWEST = 16, 0.3
DAMPINGS = np.geomspace(0.03, 0.5, 5)
CUBICS = (0.01, 0.3, 1.0, 3.0, 10.0)
COARSE, FINE = 25, 45
# With MARGIN times the machine's force the largest displacement should be at most MOST_RISE times
# the largest displacement with the machine's force. If it is larger, a branch of large motions that
# is detached from the resonance curve begins at a force near the machine's force. Harmonic balance
# predicts this force with an error of some per cent. The search then minimises the displacement
# with MARGIN times the force instead.
MARGIN, MOST_RISE = 1.1, 1.3
# REFINED    number of points of each grid that are refined
# TOLERANCE  tolerance of the refinement, in the logarithms of the unknowns and of the displacement
REFINED = 2
TOLERANCE = 2e-3


def best_absorber(machine, mass, band) -> TunedAbsorber:
    """Return the absorber that minimises the largest displacement over a band.

    Parameters
    ----------
    machine : Machine
        It must have a cubic stiffness. Its own excitation is used.
    mass : float, str or pint.Quantity
        kg.
    band : sequence of 2 floats
        Lowest and highest forcing frequency, Hz.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range, or if the machine's spring is linear. For a linear spring
        use `tuning.exact_absorber`.
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
    minima = [
        minimize(
            lambda values: worst(values[None], FINE)[0],
            start,
            method="Nelder-Mead",
            options={"xatol": TOLERANCE, "fatol": TOLERANCE},
        )
        for start in starts
    ]
    best = np.exp(min(minima, key=lambda each: each.fun).x) * unit
    names = "stiffness", "damping", "cubic_stiffness"
    return TunedAbsorber(mass=mass, **dict(zip(names, map(float, best), strict=True)))


def _unit(machine, mass, frequency):
    """Return the units of stiffness, damping and cubic stiffness in the search, in SI units."""
    w = 2 * np.pi * frequency
    cubic = tuned_cubic(mass / machine.mass, machine.cubic_stiffness)
    return np.array([mass * w**2, 2 * mass * w, cubic])


def _largest(machine, mass, absorbers, frequencies, factor):
    """Return the largest displacement of the machine with each absorber, dimensionless.

    The rows of `absorbers` are stiffness, damping and cubic stiffness in SI units. The machine's
    excitation is multiplied by `factor`.
    """
    scales = machine.scales
    bare = problems_of(machine, None, frequencies, [factor])
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
