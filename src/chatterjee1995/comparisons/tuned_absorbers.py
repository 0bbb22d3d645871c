"""Closed forms for tuned mass dampers and the nonlinear absorber, compared with responses.

A tuned mass damper is a mass on a spring and a dashpot whose natural frequency is close to the
resonance of the primary mass. The nonlinear absorber also has a cubic spring.
"""

import numpy as np
from scipy.optimize import minimize

from chatterjee1995.comparisons.comparison import Comparison
from impact_damper.theory.nonlinear_absorber import AbsorberOnDuffing, tuned_cubic
from impact_damper.theory.tuned_mass_damper import (
    Tuning,
    den_hartog,
    exact_optimum,
    fixed_point,
    least_maximum,
    peaks,
)

# Direct search for the tuning and damping that minimise the maximum of the response.
# TOLERANCE: accuracy of tuning, damping and maximum.
# MOST_STEPS: largest number of iterations.
TOLERANCE = 1e-10
MOST_STEPS = 1000


def tuned_mass_dampers(mass_ratios):
    """Compare published peaks, tunings and damping ratios with those of the computed response.

    Den Hartog tuned the absorber by the two fixed points, through which the response passes for
    every damping. Their height is compared with the highest peak of the response. The exact optimum
    of Nishihara and Asami is compared with the result of a direct search.

    Parameters
    ----------
    mass_ratios : sequence of float

    Returns
    -------
    list of Comparison
    """
    comparisons = []
    for mass in mass_ratios:
        highest = peaks(den_hartog(mass))[1].max()
        quantity = f"highest peak over static deflection, rm = {mass:g}"
        comparisons.append(
            Comparison("den_hartog", quantity, fixed_point(mass), float(highest), "fixed_points")
        )
        closed, direct = exact_optimum(mass), _least_maximum(mass)
        pairs = {
            "least maximum over static deflection": (
                least_maximum(mass),
                peaks(direct)[1].max(),
            ),
            "tuning of the least maximum": (closed.frequency, direct.frequency),
            "damping ratio of the least maximum": (closed.damping_ratio, direct.damping_ratio),
        }
        for quantity, (published, ours) in pairs.items():
            comparisons.append(
                Comparison(
                    "nishihara_asami",
                    f"{quantity}, rm = {mass:g}",
                    float(published),
                    float(ours),
                    "direct_search",
                )
            )
    return comparisons


def _least_maximum(mass) -> Tuning:
    """Return the `Tuning` with the smallest maximum of the response, by a direct search."""
    best = minimize(
        lambda values: peaks(Tuning(mass, *values))[1].max(),
        den_hartog(mass)[1:],
        method="Nelder-Mead",
        options={"xatol": TOLERANCE, "fatol": TOLERANCE, "maxiter": MOST_STEPS},
    )
    return Tuning(mass, *best.x)


def nonlinear_absorbers(mass_ratio, forces):
    """Compare the ratio of the two peaks of the response with its design value 1.

    Parameters
    ----------
    mass_ratio : float
    forces : sequence of float
        Forces on a primary mass with linear stiffness 1 and cubic coefficient 1.

    Returns
    -------
    list of Comparison

    Raises
    ------
    ArithmeticError
        If the response does not have two peaks, or if Newton's method fails.
    """
    comparisons = []
    for force in forces:
        system = AbsorberOnDuffing(mass_ratio, 1.0, tuned_cubic(mass_ratio, 1.0), force)
        heights = system.peaks().displacements
        if len(heights) != 2:
            raise ArithmeticError(f"force = {force:g}: {len(heights)} peaks in place of two")
        size = heights.max() * force
        quantity = (
            f"second peak over the first, rm = {mass_ratio:g}, "
            f"cubic over linear force {np.round(size**2, 4):g} at the peak"
        )
        comparisons.append(
            Comparison("habib", quantity, 1.0, float(heights[1] / heights[0]), "first_order")
        )
    return comparisons
