"""Approximate periodic motions, as starts of Newton's method: balance of one harmonic.

With u = U cos(W T + phase) the force in the absorber's spring and dashpot is known, from it the
motion x of the machine, and from it the force f that the motion needs: an explicit function of U,
however many motions there are at a force. In q = U^2 it is

    f^2 = q |P(q)|^2,    P = A (c0 + c1 q) + h0 + h1 q,    A = k - W^2 + i W h + (3/4) k3 |x|^2
    x = U (c0 + c1 q),   c0 = 1 - h0/(m W^2),   c1 = -h1/(m W^2)
    h0 = kappa + i W eta,    h1 = (3/4) kappa3

so that all motions of one harmonic, detached resonances too, are roots of a polynomial of degree 9.
Without an absorber x takes the place of u, with c0 = 1 and c1 = h0 = h1 = 0.
"""

import numpy as np

from impact_damper.absorbers.problems import Problems

# Largest imaginary part of a root q that counts as real, relative to its real part. Near a fold the
# roots of one harmonic may just have left the real axis where the exact motions still exist.
NEARLY_REAL = 0.02


def harmonic_seeds(problems: Problems):
    """Return the states at W T = 0 of all solutions of the balance.

    Returns
    -------
    index : numpy.ndarray of int, shape (count,)
        Problem of each solution.
    state : numpy.ndarray, shape (size, count)
    """
    terms = _coefficients(problems)
    power = _polynomial(*terms, problems.stiffness, problems.cubic, problems)
    # q = scale/y; the polynomial in y has the first coefficient 1
    scale = problems.force**2 / power[0]
    exponents = np.arange(1, len(power) + 1)[:, None]
    last = power * scale**exponents / problems.force**2
    companion = np.zeros((len(scale), len(power), len(power)))
    companion[:, 0, :] = last.T
    companion[:, np.arange(1, len(power)), np.arange(len(power) - 1)] = 1.0
    y = np.linalg.eigvals(companion)
    index, place = np.nonzero((y.real > 0) & (np.abs(y.imag) <= NEARLY_REAL * y.real))
    amplitude = np.sqrt(scale[index] / y[index, place].real)
    return index, _states(problems.take(index), amplitude)


def _coefficients(problems):
    """Return c0, c1, h0 and h1."""
    if problems.link is None:
        return 1.0 + 0j, 0.0, 0j, 0.0
    mass, stiffness, damping, cubic = problems.link
    w = problems.frequency
    h0, h1 = stiffness + 1j * w * damping, 0.75 * cubic
    return 1 - h0 / (mass * w**2), -h1 / (mass * w**2), h0, h1


def _polynomial(c0, c1, h0, h1, stiffness, cubic, problems):
    """Return the coefficients of q, q^2, ..., q^9 in q |P(q)|^2, shape (9, n)."""
    w, g = problems.frequency, 0.75 * cubic
    linear = stiffness - w**2 + 1j * w * problems.damping
    size = [abs(c0) ** 2, 2 * np.real(c0) * c1, c1**2]
    p = np.array(
        np.broadcast_arrays(
            linear * c0 + h0,
            linear * c1 + g * size[0] * c0 + h1,
            g * (size[1] * c0 + size[0] * c1),
            g * (size[2] * c0 + size[1] * c1),
            g * size[2] * c1,
        )
    )
    found = np.zeros((9, len(w)))
    for i in range(5):
        for j in range(5):
            found[i + j] += (p[i] * p[j].conj()).real
    return found


def _states(problems, amplitude):
    """Return the states at W T = 0 of motions with amplitudes of u (or x), turned to the force."""
    w = problems.frequency
    c0, c1, h0, h1 = _coefficients(problems)
    q = amplitude**2
    x = amplitude * (c0 + c1 * q)
    spring = problems.stiffness + 0.75 * problems.cubic * np.abs(x) ** 2
    force = (spring - w**2 + 1j * w * problems.damping) * x + amplitude * (h0 + h1 * q)
    turn = np.abs(force) / force
    motions = [x * turn, amplitude * turn][: problems.size // 2]
    return np.array([row for z in motions for row in (z.real, -w * z.imag)])
