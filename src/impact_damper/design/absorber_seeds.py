"""First guesses for Newton's method: periodic motions by harmonic balance with one harmonic.

Let u = U cos(T + phase) be the motion of the machine relative to the absorber. It determines the
force in the absorber's spring and dashpot. This force determines the motion x of the machine, and x
determines the external force of amplitude f that the motion needs. Therefore f is an explicit
function of U, even if several motions have the same f. Let the machine have the stiffness k,
damping h and cubic stiffness k3, and the absorber the mass m, stiffness kappa, damping eta and
cubic stiffness kappa3. All are divided by the mass of the machine, in units of time in which the
forcing is f cos T (`problems`). With q = U^2

    f^2 = q |P(q)|^2,    P = A (c0 + c1 q) + h0 + h1 q,    A = k - 1 + i h + (3/4) k3 |x|^2
    x = U (c0 + c1 q),   c0 = 1 - h0/m,   c1 = -h1/m,   h0 = kappa + i eta,   h1 = (3/4) kappa3

All motions with one harmonic, also detached resonances, are therefore roots of a polynomial of
degree 9 in q, or of degree 3 if only one of the two springs is nonlinear. Without an absorber x
takes the place of u, with c0 = 1 and c1 = h0 = h1 = 0.
"""

import numpy as np

from impact_damper.design.absorber_problems import active_size
from impact_damper.design.smooth_runs import (
    CUBIC,
    DAMPING,
    FORCE,
    INVERSE_MASS,
    LINK_CUBIC,
    LINK_DAMPING,
    LINK_STIFFNESS,
    STIFFNESS,
)

# Largest imaginary part, as a fraction of the real part, with which a root y = scale/q (see
# `_solutions`) counts as real. REAL allows for rounding errors. Near a fold, exact motions may
# exist although two roots of the balance have just become complex. Therefore the first guesses come
# from all roots within NEARLY_REAL.
REAL, NEARLY_REAL = 1e-5, 0.1


def harmonic_seeds(problems):
    """Return the states at T = 0 of all solutions of the balance, as first guesses of orbits.

    Parameters
    ----------
    problems : numpy.ndarray, shape (n, COUNT)

    Returns
    -------
    index : numpy.ndarray of int, shape (count,)
        Problem of each solution.
    state : numpy.ndarray, shape (count, SIZE)
    """
    index, amplitude = _solutions(problems, NEARLY_REAL)
    x, u = _motion(problems[index], amplitude)
    return index, np.column_stack([x.real, -x.imag, u.real, -u.imag])


def harmonic_displacements(problems):
    """Return the largest amplitude of x among the solutions of the balance, shape (n,)."""
    index, amplitude = _solutions(problems, REAL)
    largest = np.zeros(len(problems))
    np.maximum.at(largest, index, np.abs(_motion(problems[index], amplitude)[0]))
    return largest


def _solutions(problems, allowed):
    """Return the problem and the amplitude of u (or x) of all roots that are nearly real.

    In a nearly real root the imaginary part is at most `allowed` times the real part.
    """
    power, force = _polynomial(problems), problems[:, FORCE]
    # With q = scale/y the polynomial in y has the coefficients 1 of y^9 and -1 of y^8.
    scale, degree = force**2 / power[0], len(power)
    companion = np.zeros((len(problems), degree, degree))
    companion[:, 0, :] = (power * scale ** np.arange(1, degree + 1)[:, None] / force**2).T
    companion[:, np.arange(1, degree), np.arange(degree - 1)] = 1.0
    y = np.linalg.eigvals(companion)
    index, place = np.nonzero((y.real > 0) & (np.abs(y.imag) <= allowed * y.real))
    return index, np.sqrt(scale[index] / y[index, place].real)


def _coefficients(problems):
    """Return c0, c1, h0 and h1."""
    if active_size(problems) == 2:
        return 1.0, 0.0, 0.0, 0.0
    h0 = problems[:, LINK_STIFFNESS] + 1j * problems[:, LINK_DAMPING]
    h1 = 0.75 * problems[:, LINK_CUBIC]
    return 1 - h0 * problems[:, INVERSE_MASS], -h1 * problems[:, INVERSE_MASS], h0, h1


def _polynomial(problems):
    """Return the coefficients of q, q^2, ..., q^9 in q |P(q)|^2, shape (9, n)."""
    c0, c1, h0, h1 = _coefficients(problems)
    g, linear = 0.75 * problems[:, CUBIC], problems[:, STIFFNESS] - 1 + 1j * problems[:, DAMPING]
    # |x|^2 = q (size[0] + size[1] q + size[2] q^2)
    size = [np.abs(c0) ** 2, 2 * np.real(c0) * c1, c1**2]
    p = np.broadcast_arrays(
        linear * c0 + h0,
        linear * c1 + g * size[0] * c0 + h1,
        g * (size[1] * c0 + size[0] * c1),
        g * (size[2] * c0 + size[1] * c1),
        g * size[2] * c1,
    )
    product = np.zeros((2 * len(p) - 1, len(problems)))
    for i, one in enumerate(p):
        for j, other in enumerate(p):
            product[i + j] += (one * np.conj(other)).real
    return product


def _motion(problems, amplitude):
    """Return x and u as complex amplitudes with the phase for which the force is f cos T."""
    c0, c1, h0, h1 = _coefficients(problems)
    q = amplitude**2
    x = amplitude * (c0 + c1 * q)
    spring = problems[:, STIFFNESS] + 0.75 * problems[:, CUBIC] * np.abs(x) ** 2
    force = (spring - 1 + 1j * problems[:, DAMPING]) * x + amplitude * (h0 + h1 * q)
    turn = np.abs(force) / force
    return x * turn, amplitude * turn
