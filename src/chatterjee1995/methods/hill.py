"""Floquet exponents by Hill's method (Lazarus and Thomas, C. R. Mecanique 338, 510, 2010)."""

from typing import NamedTuple

import numpy as np
from scipy.linalg import eigvals, lu_factor, lu_solve
from scipy.sparse.linalg import ArpackNoConvergence, LinearOperator, eigs

# With more than DENSE unknowns, only the 4 * COPIES eigenvalues nearest to 0 are computed.
DENSE, COPIES = 100, 3
# Each exponent is found several times, in copies that differ by 2 i W, since the linearised
# equations repeat after half a cycle. The copy with -W < Im <= W is kept. If Im differs from W or
# from -W by less than EDGE * W, it counts as W or -W.
EDGE = 1e-2


class Exponents(NamedTuple):
    """The Floquet exponents, in the order of rising real parts: 4 with a damper, 2 without.

    The status is "found"; "not_converged" if the search for eigenvalues fails; "not_separated" if
    the search finds too few or too many exponents. In the last two cases all values are NaN.
    """

    values: np.ndarray
    status: str

    def multipliers(self, time) -> np.ndarray:
        """Return the Floquet multipliers exp(exponent * time). `time` is the orbit's period."""
        return np.exp(self.values * time)


def exponents(solution) -> Exponents:
    """Return the Floquet exponents of a solution of harmonic balance."""
    balance = solution.balance
    dimension = 2 if balance.damper is None else 4
    orbit, contacts = solution.coefficients, balance.contacts(solution.coefficients)
    unknown = np.full(dimension, complex(np.nan, np.nan))
    try:
        copies = _near_zero(*(balance.operator(orbit, contacts, power) for power in range(3)))
    except ArpackNoConvergence:
        return Exponents(unknown, "not_converged")
    height = copies.imag / balance.frequency
    inside = np.where(height > 1 - EDGE, copies.real + 1j * balance.frequency, copies)
    inside = inside[(height > -1 + EDGE) & (height < 1 + EDGE)]
    if len(inside) != dimension:
        return Exponents(unknown, "not_separated")
    return Exponents(inside[np.lexsort((inside.imag, inside.real))], "found")


def _near_zero(stiffness, damping, inertia):
    """Return lambda near 0 for which stiffness + lambda damping + lambda^2 inertia is singular."""
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
