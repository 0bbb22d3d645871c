"""Hill's method: Floquet exponents of a motion from the Fourier series of its linearisation.

A disturbance exp(lambda T) p(T) with p periodic turns the linearised equations into the quadratic
eigenproblem (Q0 + lambda Q1 + lambda^2 Q2) p = 0 of `multiharmonic.Balance.operator`, truncated at
the same harmonics. In contact the force on it is r1 M p + c (d/dT + lambda)(M p): the rate of
M p holds the impulses by which a displaced entry or exit counts where the dashpot's force
jumps, so there is nothing else to add (the same as the saltation of `kernel.dashpot_jump`).

The infinite problem has each exponent again and again, spaced by i times the rate s at which p
may be shifted: 2 nu for odd harmonics (those of a symmetric motion map odd p to odd p), nu for
all. The truncated problem has good copies near the middle and bad ones at its ends. Kept are those
with -s/2 < Im lambda <= s/2; their number must be that of the states, or the status says so.

Compare Lazarus and Thomas, C. R. Mecanique 338, 510 (2010), on choosing among the copies.
"""

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigvals, lu_factor, lu_solve
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigs

# Eigenvalues are computed near zero only, COPIES of each exponent, beyond DENSE unknowns.
DENSE = 100
COPIES = 3
# An imaginary part so close to s/2, as a share of it, is taken as s/2: a real negative
# multiplier over the shift, whose two copies at the edges of the strip are one exponent.
EDGE = 1e-2


class Exponents(NamedTuple):
    """Floquet exponents of a solution of harmonic balance.

    Attributes
    ----------
    values : numpy.ndarray, shape (2 or 4,)
        Per unit time, complex; NaN unless the status is "found".
    status : str
        "found", "not_separated" (the strip does not hold as many as there are states), or
        "not_converged" (the iteration for the eigenvalues near zero).
    """

    values: np.ndarray
    status: str

    def multipliers(self, time) -> np.ndarray:
        """Floquet multipliers over a time."""
        return np.exp(self.values * time)


def exponents(solution) -> Exponents:
    """Floquet exponents of a `multiharmonic.Solution`."""
    balance = solution.balance
    number = 2 if balance.damper is None else 4
    orbit, rows = solution.coefficients, balance.contacts(solution.coefficients)
    unknown = np.full(number, complex(np.nan, np.nan))
    try:
        found = _near_zero(*(balance.operator(orbit, rows, power) for power in range(3)))
    except ArpackNoConvergence:
        return Exponents(unknown, "not_converged")
    strip = balance.frequency / balance.period / (1 if balance.symmetric else 2)
    height = found.imag / strip
    inside = np.where(height > 1 - EDGE, found.real + 1j * strip, found)
    inside = inside[(height > -1 + EDGE) & (height < 1 + EDGE)]
    if len(inside) != number:
        return Exponents(unknown, "not_separated")
    return Exponents(inside[np.lexsort((inside.imag, inside.real))], "found")


def _near_zero(stiffness, damping, inertia):
    """Eigenvalues of the quadratic problem, those nearest zero if the problem is large.

    The inverse of the problem's first-order form, whose largest eigenvalues these are, needs
    the factors of the Jacobian alone.
    """
    size = len(stiffness)
    factors = lu_factor(stiffness, check_finite=False)

    def inverse(vector):
        place, rate = vector[:size], vector[size:]
        return np.concatenate([-lu_solve(factors, damping @ place + inertia @ rate), place])

    if size <= DENSE:
        inverted = eigvals(np.stack([inverse(unit) for unit in np.eye(2 * size)], axis=1))
    else:
        operator = LinearOperator((2 * size, 2 * size), inverse, dtype=float)
        start = np.random.default_rng(0).standard_normal(2 * size)
        inverted = eigs(operator, 4 * COPIES, which="LM", v0=start, return_eigenvectors=False)
    return 1 / inverted[np.abs(inverted) > 1e-9 * np.max(np.abs(inverted))]
