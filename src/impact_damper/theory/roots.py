"""Find all real roots of a smooth function from its signs at neighbouring extrema.

An extremum at which the function is 0, within rounding errors, is a double root.
"""

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.polynomial import polyder, polyroots, polyval
from scipy.optimize import brentq

EPSILON = np.finfo(float).eps
# A function counts as 0 if it is at most ROUNDING times the sum of its terms' absolute values.
ROUNDING = 16 * EPSILON
LARGEST_DEGREE = 512
# An interval is halved if the bound on the rounding error varies in it by more than this factor.
LARGEST_RANGE = 1e6


def polynomial_roots(coefficients) -> np.ndarray:
    """Return the real roots of a polynomial, ascending; a double root is listed once."""
    coefficients = np.trim_zeros(np.asarray(coefficients, float), "b")
    if len(coefficients) < 2:
        return np.empty(0)
    reach = 2 * np.max(np.abs(polyroots(coefficients))) or 1.0
    return _between(
        lambda x: polyval(x, coefficients),
        lambda x: polyval(np.abs(x), np.abs(coefficients)),
        polyroots(polyder(coefficients)),
        -reach,
        reach,
    )


def smooth_roots(function, size, lower, upper) -> np.ndarray:
    """Return the real roots of an analytic function in [lower, upper], each listed once.

    EPSILON * size(x) must bound the rounding error of function(x). A Chebyshev polynomial gives the
    extrema (Trefethen, Approximation Theory and Approximation Practice, 2013, chapter 18).
    """
    sizes = size(np.linspace(lower, upper, 17))
    if np.max(sizes) > LARGEST_RANGE * np.min(sizes):
        middle = (lower + upper) / 2
        halves = [(lower, middle), (middle, upper)]
        return np.unique(np.concatenate([smooth_roots(function, size, *half) for half in halves]))
    rounding = ROUNDING * np.max(sizes)
    degree = 16
    while degree <= LARGEST_DEGREE:
        interpolant = Chebyshev.interpolate(function, degree, [lower, upper])
        if np.max(np.abs(interpolant.coef[-3:])) <= rounding:
            extrema = interpolant.trim(rounding).deriv().roots()
            return _between(function, size, extrema, lower, upper)
        degree *= 2
    span = f"[{lower:g}, {upper:g}]"
    raise ArithmeticError(f"degree {LARGEST_DEGREE} does not resolve the function on {span}")


def _between(function, size, extrema, lower, upper):
    points = np.unique(np.clip(np.concatenate([[lower, upper], np.real(extrema)]), lower, upper))
    values = function(points)
    if not np.isfinite(values).all():
        raise ArithmeticError(f"a function overflows between {points[0]:g} and {points[-1]:g}")
    signs = np.where(np.abs(values) <= ROUNDING * size(points), 0, np.sign(values))
    roots = [
        brentq(function, points[k], points[k + 1], xtol=1e-300, rtol=4 * EPSILON)
        for k in np.flatnonzero(signs[:-1] * signs[1:] < 0)
    ]
    return np.sort(np.concatenate([roots, points[signs == 0]]))
