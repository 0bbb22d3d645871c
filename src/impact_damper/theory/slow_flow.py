"""Slow flow (17) and its Jacobian in the complex amplitudes A = a exp(i t1), C = b exp(i t2).

Unlike the polar equations of the paper these are regular at a = 0, the design point, and have the
same eigenvalues elsewhere.
"""

import numpy as np

from impact_damper.model.bounds import check_frequency
from impact_damper.theory.single_harmonic import contact_amplitude

# A motion whose growth rate has a modulus of at most MARGIN counts as marginally stable.
MARGIN = 1e-9


def slow_flow(state, oscillator, damper, frequency) -> np.ndarray:
    """Return the time derivatives of the slow amplitudes, equation (17)."""
    frequency = check_frequency(frequency)
    state = np.asarray(state, float)
    primary = state[..., 0] + 1j * state[..., 1]
    drag = oscillator.damping * frequency * primary
    spring = oscillator.linear_frequency**2 + oscillator.hardening * np.abs(primary) ** 2
    spring = spring * primary
    force = oscillator.forcing_amplitude(frequency)
    first = drag + 1j * (force - spring + frequency**2 * primary)
    if damper is None:
        rates = [first]
    else:
        loose = state[..., 2] + 1j * state[..., 3]
        push = _push(loose, damper)[0] * loose
        total = (1 + 1 / damper.mass_ratio) * push
        rates = [first - 1j * push, drag + 1j * (force - spring + frequency**2 * loose - total)]
    parts = [part for rate in rates for part in (rate.real, rate.imag)]
    return -np.stack(parts, axis=-1) / (2 * frequency)


def jacobian(state, oscillator, damper, frequency) -> np.ndarray:
    """Return the Jacobian of `slow_flow` with respect to the state.

    This is appendix A in complex amplitudes. The arguments are as in `slow_flow`.
    """
    frequency = check_frequency(frequency)
    state = np.asarray(state, float)
    primary = state[..., 0] + 1j * state[..., 1]
    drag = oscillator.damping * frequency
    spring = oscillator.linear_frequency**2 + 2 * oscillator.hardening * np.abs(primary) ** 2
    twisted = -1j * oscillator.hardening * primary**2
    own = _block(drag + 1j * (frequency**2 - spring), twisted)
    if damper is None:
        return -own / (2 * frequency)
    _, along, across = _push(state[..., 2] + 1j * state[..., 3], damper)
    total = 1 + 1 / damper.mass_ratio
    upper = np.concatenate([own, _block(-1j * along, -1j * across)], axis=-1)
    lower = np.concatenate(
        [
            _block(drag - 1j * spring, twisted),
            _block(1j * (frequency**2 - total * along), -1j * total * across),
        ],
        axis=-1,
    )
    return -np.concatenate([upper, lower], axis=-2) / (2 * frequency)


def growth_rate(state, oscillator, damper, frequency) -> np.ndarray:
    """Return the largest real part of the eigenvalues of `jacobian` at each state, shape (...)."""
    matrices = jacobian(state, oscillator, damper, frequency)
    return np.max(np.real(np.linalg.eigvals(matrices)), axis=-1)


def fixed_points(solutions) -> np.ndarray:
    """Return the states of harmonic-balance solutions, which are fixed points of the slow flow."""
    turn = np.exp(1j * solutions.phase)
    parts = [
        part
        for size in solutions
        if size is not solutions.phase
        for part in ((size * turn).real, (size * turn).imag)
    ]
    return np.stack(parts, axis=-1)


def stability(growth) -> np.ndarray:
    """Return the flag `stability` of growth rates.

    The flag is 1 (stable) below -MARGIN, -1 (unstable) above MARGIN, and 0 (marginal) between.
    """
    return -np.sign(np.where(np.abs(growth) <= MARGIN, 0.0, growth)).astype(int)


def _push(loose, damper):
    """Return r1 B(b)/b, and the derivatives of r1 (B/b) C with respect to C and conj(C).

    B is the first harmonic of the contact force divided by r1, equation (6e), and b = |C|.
    """
    size = np.abs(loose)
    contact, slope = contact_amplitude(size, damper.clearance)
    size = np.maximum(size, damper.clearance)
    ratio = contact / size
    stiffness = damper.contact_stiffness
    return (
        stiffness * ratio,
        stiffness * (slope + ratio) / 2,
        stiffness * (slope - ratio) / 2 * (loose / size) ** 2,
    )


def _block(by_value, by_conjugate):
    """Return the real 2 x 2 matrices of dz -> by_value dz + by_conjugate conj(dz)."""
    total, difference = by_value + by_conjugate, by_value - by_conjugate
    rows = [
        np.stack([total.real, -difference.imag], axis=-1),
        np.stack([total.imag, difference.real], axis=-1),
    ]
    return np.stack(rows, axis=-2)
