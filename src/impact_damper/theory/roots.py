"""All real roots of a smooth function of one variable, double roots included.

Between neighbouring extrema a function is monotone: a change of sign there is
one root and no more, no change of sign is no root, and an extremum that is zero
to rounding is a double root. Nothing is decided by the imaginary part of a
computed root, so a double root is never lost.
"""

import numpy as np
from numpy.polynomial import Chebyshev
from numpy.polynomial.polynomial import polyder, polyroots, polyval
from scipy.optimize import brentq

EPSILON = np.finfo(float).eps
ROUNDING = 16 * EPSILON
LARGEST_DEGREE = 512
LARGEST_RANGE = 1e6


def polynomial_roots(coefficients) -> np.ndarray:
    """Real roots of a polynomial, ascending, a double root once.

    Parameters
    ----------
    coefficients : array_like
        Lowest power first; the last must not be zero.
    """
    reach = 2 * np.max(np.abs(polyroots(coefficients))) or 1.0
    return _between(
        lambda x: polyval(x, coefficients),
        lambda x: polyval(np.abs(x), np.abs(coefficients)),
        polyroots(polyder(coefficients)),
        -reach,
        reach,
    )


def smooth_roots(function, size, lower, upper) -> np.ndarray:
    """Real roots of an analytic function in [lower, upper], ascending, a double root once.

    The function is replaced by a Chebyshev interpolant whose degree is doubled until
    its last coefficients have fallen to rounding; an interval in which that rounding
    differs by more than 1e6 is halved first. The interpolant gives the extrema,
    as eigenvalues of a companion matrix (Trefethen, Approximation Theory and
    Approximation Practice, 2013, chapter 18); the function itself gives the roots.

    Parameters
    ----------
    function : callable
        Maps x, a number or an array, to its value.
    size : callable
        Maps an array x to the sum of the sizes of the terms of the function, which says
        how much of a value may be rounding; positive.
    lower, upper : float
        Ends of the interval.

    Raises
    ------
    ArithmeticError
        If the function needs a degree above 512.
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
    raise ArithmeticError(
        f"degree {LARGEST_DEGREE} does not resolve the function on [{lower:g}, {upper:g}]"
    )


def _between(function, size, extrema, lower, upper):
    """Roots of `function` in [lower, upper], which the real parts of its `extrema` split."""
    points = np.unique(np.clip(np.concatenate([[lower, upper], np.real(extrema)]), lower, upper))
    values = function(points)
    signs = np.where(np.abs(values) <= ROUNDING * size(points), 0, np.sign(values))
    roots = [
        brentq(function, points[k], points[k + 1], xtol=1e-300, rtol=4 * EPSILON)
        for k in np.flatnonzero(signs[:-1] * signs[1:] < 0)
    ]
    return np.sort(np.concatenate([roots, points[signs == 0]]))
