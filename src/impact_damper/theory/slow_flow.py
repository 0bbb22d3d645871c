"""Stability of harmonic-balance solutions by the slow flow (17) in complex amplitudes.

With A = a exp(i t1) and C = b exp(i t2) the slow flow is regular at the design point a = 0. The
paper's polar equations are singular there. Elsewhere both have the same eigenvalues.
"""

import numpy as np

from impact_damper.theory.single_harmonic import contact_amplitude

# Largest modulus of the growth rate of a marginally stable motion.
MARGIN = 1e-9


def jacobian(state, oscillator, damper, frequency) -> np.ndarray:
    """Return the Jacobian of the slow flow, appendix A in complex amplitudes, shape (..., k, k).

    `state` (..., k) holds Re A, Im A, and with a damper Re C, Im C.
    """
    state = np.asarray(state, float)
    primary = state[..., 0] + 1j * state[..., 1]
    drag = oscillator.damping * frequency
    spring = oscillator.linear_frequency**2 + 2 * oscillator.hardening * np.abs(primary) ** 2
    twisted = -1j * oscillator.hardening * primary**2
    own = _block(drag + 1j * (frequency**2 - spring), twisted)
    if damper is None:
        return -own / (2 * frequency)
    along, across = _push_slopes(state[..., 2] + 1j * state[..., 3], damper)
    total = 1 + 1 / damper.mass_ratio
    upper = [own, _block(-1j * along, -1j * across)]
    pushed = _block(1j * (frequency**2 - total * along), -1j * total * across)
    lower = [_block(drag - 1j * spring, twisted), pushed]
    return -np.block([upper, lower]) / (2 * frequency)


def growth_rate(state, oscillator, damper, frequency) -> np.ndarray:
    """Return the largest real part of the eigenvalues of `jacobian` at each state, shape (...)."""
    matrices = jacobian(state, oscillator, damper, frequency)
    return np.max(np.real(np.linalg.eigvals(matrices)), axis=-1)


def fixed_points(solutions) -> np.ndarray:
    """Return the states of harmonic-balance solutions, which are fixed points of the slow flow."""
    *sizes, phase = solutions
    return np.stack([size * np.exp(1j * phase) for size in sizes], axis=-1).view(float)


def stability(growth) -> np.ndarray:
    """Return the flag of growth rates: 1 (stable), -1 (unstable), 0 (marginal, within MARGIN)."""
    return -np.sign(np.where(np.abs(growth) <= MARGIN, 0.0, growth)).astype(int)


def _push_slopes(loose, damper):
    """Return the derivatives of r1 (B/b) C, with b = |C|, with respect to C and conj(C)."""
    size = np.abs(loose)
    contact, slope = contact_amplitude(size, damper.clearance)
    size = np.maximum(size, damper.clearance)
    ratio = contact / size
    stiffness = damper.contact_stiffness
    return stiffness * (slope + ratio) / 2, stiffness * (slope - ratio) / 2 * (loose / size) ** 2


def _block(by_value, by_conjugate):
    """Return the real 2 x 2 matrices of dz -> by_value dz + by_conjugate conj(dz)."""
    total, difference = by_value + by_conjugate, by_value - by_conjugate
    rows = [
        np.stack([total.real, -difference.imag], axis=-1),
        np.stack([total.imag, difference.real], axis=-1),
    ]
    return np.stack(rows, axis=-2)
