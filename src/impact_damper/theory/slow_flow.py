"""Slow flow (17) in the Cartesian amplitudes A = a exp(i t1), C = b exp(i t2), and its Jacobian.

Z1 = Re(A exp(i W T)) and Z2 = Re(C exp(i W T)) with slowly varying A and C. Times
exp(-i t1) and exp(-i t2) the real and imaginary parts are (17a) to (17d); unlike
those, these have no singularity at a = 0, where the design sits. The eigenvalues
at a fixed point are the same.
"""

import numpy as np

from impact_damper.system.parameters import check_frequency
from impact_damper.theory.single_harmonic import contact_amplitude

MARGIN = 1e-9


def slow_flow(state, oscillator, damper, frequency) -> np.ndarray:
    """Rates of the slow amplitudes, equation (17).

    Parameters
    ----------
    state : array_like, shape (..., 4)
        Re A, Im A, Re C, Im C. With `damper=None` shape (..., 2), Re A and Im A.
    oscillator, damper, frequency
        The forced oscillator, its damper or None, and W.

    Returns
    -------
    numpy.ndarray
        Rates, shaped as `state`.
    """
    frequency = check_frequency(frequency)
    state = np.asarray(state, float)
    primary = state[..., 0] + 1j * state[..., 1]
    drag = oscillator.damping * frequency * primary
    spring = (oscillator.linear_frequency**2 + 0.75 * np.abs(primary) ** 2) * primary
    first = drag + 1j * (1 - spring + frequency**2 * primary)
    if damper is None:
        rates = [first]
    else:
        loose = state[..., 2] + 1j * state[..., 3]
        push = _push(loose, damper)[0] * loose
        total = (1 + 1 / damper.mass_ratio) * push
        rates = [first - 1j * push, drag + 1j * (1 - spring + frequency**2 * loose - total)]
    parts = [part for rate in rates for part in (rate.real, rate.imag)]
    return -np.stack(parts, axis=-1) / (2 * frequency)


def jacobian(state, oscillator, damper, frequency) -> np.ndarray:
    """Derivatives of `slow_flow` by the state, appendix A in Cartesian amplitudes.

    Returns
    -------
    numpy.ndarray, shape (..., 4, 4)
        Or (..., 2, 2) with `damper=None`.
    """
    frequency = check_frequency(frequency)
    state = np.asarray(state, float)
    primary = state[..., 0] + 1j * state[..., 1]
    drag = oscillator.damping * frequency
    spring = oscillator.linear_frequency**2 + 1.5 * np.abs(primary) ** 2
    twisted = -0.75j * primary**2
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
    """Largest real part of the eigenvalues of the Jacobian at each state, shape (...)."""
    matrices = jacobian(state, oscillator, damper, frequency)
    return np.max(np.real(np.linalg.eigvals(matrices)), axis=-1)


def fixed_points(solutions) -> np.ndarray:
    """States of harmonic-balance `Solutions` (count, 4), or of `FreeSolutions` (count, 2)."""
    turn = np.exp(1j * solutions.phase)
    parts = [
        part
        for size in solutions
        if size is not solutions.phase
        for part in ((size * turn).real, (size * turn).imag)
    ]
    return np.stack(parts, axis=-1)


def stability(growth) -> np.ndarray:
    """1 (stable) for a growth rate below -1e-9, -1 (unstable) above 1e-9, 0 (marginal) between."""
    return -np.sign(np.where(np.abs(growth) <= MARGIN, 0.0, growth)).astype(int)


def _push(loose, damper):
    """r1 B(b)/b, and the derivatives of r1 (B/b) C by C and by its conjugate."""
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
    """Real 2 x 2 matrices of the map dz -> by_value dz + by_conjugate conj(dz)."""
    total, difference = by_value + by_conjugate, by_value - by_conjugate
    rows = [
        np.stack([total.real, -difference.imag], axis=-1),
        np.stack([total.imag, difference.real], axis=-1),
    ]
    return np.stack(rows, axis=-2)
