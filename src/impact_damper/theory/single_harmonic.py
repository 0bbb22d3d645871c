"""Single-term harmonic balance with the damper: the paper's equations (6), (7), (13), (14), (17).

In a solution Z1 = a cos(W T + t1) and Z2 = b cos(W T + t1) with b > 0. If a < 0, Z1 and Z2 are in
antiphase. Walls are elastic. Stability follows from the slow flow (17), the equations for slowly
varying amplitudes and phases. In the slow flow the phase t2 of Z2 may differ from t1. This module
writes the slow flow for A = a exp(i t1) and C = b exp(i t2). The paper writes it for a, b, t1, t2,
which is singular at a = 0. Elsewhere both forms have the same eigenvalues.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.model.bounds import check_frequency
from impact_damper.model.parameters import check_closed_form
from impact_damper.model.text import plain
from impact_damper.theory.free_oscillator import free_solutions
from impact_damper.theory.roots import polynomial_roots, smooth_roots


class Solutions(NamedTuple):
    """Solutions at one frequency: amplitudes a of Z1 and b of Z2, and phases t1, shape (count,)."""

    amplitude: np.ndarray
    relative_amplitude: np.ndarray
    phase: np.ndarray


def contact_amplitude(relative_amplitude, clearance) -> tuple:
    """Return B and dB/db for the amplitude b of Z2. r1 B is the harmonic of the contact force (6e).

    B = b (2/pi)(p - sin p cos p) with the contact angle p = arccos(d0/b). B is 0 for b <= d0.
    """
    amplitude = np.maximum(relative_amplitude, clearance)
    angle = np.arctan2(np.sqrt((amplitude - clearance) * (amplitude + clearance)), clearance)
    slope = (2 / np.pi) * (angle + np.sin(angle) * np.cos(angle))
    return amplitude * (2 / np.pi) * _excess(angle), slope


def rigid_solutions(oscillator, damper, frequency) -> Solutions:
    """Return the solutions of (13), by ascending phase t1. They have b = d0.

    Some of them have a > d0 and need walls that pull. Equation (7) has no such solution. For a
    forcing amplitude f other than 1, (13) holds with d0/f, k3 f^2, a/f in place of d0, k3, a.
    """
    check_elastic(oscillator, damper)
    frequency = check_frequency(frequency)
    force = oscillator.forcing_amplitude(frequency)
    if force == 0:
        return Solutions(*np.empty((3, 0)))
    inertia = damper.mass_ratio * frequency**2
    detuning = oscillator.linear_frequency**2 - frequency**2
    drag = oscillator.damping * frequency
    odd = -2 / drag * (detuning - inertia)
    cubic = -8 * oscillator.hardening * force**2 / drag**3
    push = inertia * damper.clearance / force
    terms = [push - 1, odd, 3 * push - 1, cubic + 2 * odd, 3 * push + 1, odd, push + 1]
    tangent = polynomial_roots(terms)
    amplitude = -2 * force * tangent / (drag * (1 + tangent**2))
    clearance = np.full(len(tangent), damper.clearance)
    return Solutions(amplitude, clearance, 2 * np.arctan(tangent))


def impacting_solutions(oscillator, damper, frequency) -> Solutions:
    """Return all solutions of (7), by ascending contact angle p, where cos(p) = d0/b.

    (7c) gives a(p) = (d0/cos p)(1 - k (p - sin p cos p)) with k = 2 r1/(pi rm W^2). Eliminating
    t1 from (7a, b) leaves one equation for p, with g = (3/4) k3 and the forcing amplitude f:

        G(p) = (a wl^2 - a W^2 + g a^3 + rm W^2 (b - a))^2 + (h a W)^2 - f^2 = 0.

    `smooth_roots` finds all roots of cos^6(p) G(p), a function without poles.
    """
    check_elastic(oscillator, damper)
    balance = _Balance(oscillator, damper, check_frequency(frequency))
    lower, upper = balance.angle_range()
    if not lower < upper:
        return Solutions(*np.empty((3, 0)))
    angle = smooth_roots(balance.defect, balance.defect_size, lower, upper)
    cosine, scaled, inline, quadrature = balance.terms(angle)
    return Solutions(scaled / cosine, damper.clearance / cosine, np.arctan2(-quadrature, inline))


def resting_solutions(oscillator, damper, frequency) -> Solutions:
    """Return free solutions with an amplitude below d0: the loose mass rests in space, Z2 = Z1."""
    check_closed_form(oscillator, damper)
    free = free_solutions(oscillator, frequency)
    inside = free.amplitude < damper.clearance
    return Solutions(free.amplitude[inside], free.amplitude[inside], free.phase[inside])


class _Balance:
    """Terms of (7), multiplied by powers of cos(p). The contact angle p is arccos(d0/b)."""

    def __init__(self, oscillator, damper, frequency):
        self.clearance = damper.clearance
        self.detuning = oscillator.linear_frequency**2 - frequency**2
        self.drag = oscillator.damping * frequency
        self.hardening = oscillator.hardening
        self.force = oscillator.forcing_amplitude(frequency)
        self.inertia = damper.mass_ratio * frequency**2
        self.stiffness = 2 * damper.contact_stiffness / (np.pi * self.inertia)

    def terms(self, angle):
        """Return cos p, a cos p, f cos(t1) cos^3 p, -f sin(t1) cos^3 p (p: contact angle)."""
        cosine = np.cos(angle)
        scaled = self.scaled_amplitude(angle)
        force = self.inertia * (self.clearance - scaled)
        spring = self.detuning * cosine**2 + self.hardening * scaled**2
        inline = scaled * spring + force * cosine**2
        return cosine, scaled, inline, self.drag * scaled * cosine**2

    def scaled_amplitude(self, angle):
        """Return a cos(p) by (7c): a is the amplitude of Z1, and p the contact angle `angle`."""
        return self.clearance * (1 - self.stiffness * _excess(angle))

    def defect(self, angle):
        """Return cos^6(p) G(p) at the contact angle p. `impacting_solutions` defines G."""
        cosine, _, inline, quadrature = self.terms(angle)
        return inline**2 + quadrature**2 - self.force**2 * cosine**6

    def defect_size(self, angle):
        """Return a bound on the rounding error of `defect`, divided by the machine epsilon."""
        cosine, scaled, inline, quadrature = self.terms(angle)
        square = cosine**2
        error = 2 * self.clearance - scaled
        slope = (abs(self.detuning) + self.inertia) * square + 3 * abs(self.hardening) * scaled**2
        inline_error = error * slope
        return (
            2 * np.abs(inline) * inline_error
            + 2 * np.abs(quadrature) * self.drag * error * square
            + inline**2
            + quadrature**2
            + self.force**2 * square**3
        )

    def angle_range(self):
        """Return bounds on the contact angle p = arccos(d0/b) of all solutions of (7)."""
        # (7b) bounds |a| by `reach`. (7a) gives a second bound, as its cubic term grows like |a|^3.
        reach = self.force / self.drag
        if reach == 0:
            return 0.0, 0.0
        lower, upper = self._angles_within(reach)
        if self.hardening == 0:
            return lower, upper
        constant = self.force + self.inertia * self.clearance / np.cos(upper)
        slope, cubic = abs(self.detuning) + self.inertia, abs(self.hardening)
        bound = max(np.sqrt(2 * slope / cubic), np.cbrt(2 * constant / cubic))
        return self._angles_within(bound) if bound < reach else (lower, upper)

    def _angles_within(self, reach):
        reach *= 1 + 1e-6
        spring = reach * (abs(self.detuning) + abs(self.hardening) * reach**2)
        largest = reach + (self.force + spring) / self.inertia
        last = np.arccos(min(1, self.clearance / largest))

        def above(angle, amplitude):
            return self.scaled_amplitude(angle) - amplitude * np.cos(angle)

        if above(last, -reach) < 0:
            last = brentq(above, 0, last, args=(-reach,))
        if self.clearance <= reach:
            return 0.0, last
        return (brentq(above, 0, last, args=(reach,)) if above(last, reach) < 0 else last), last


def _excess(angle):
    """Return p - sin(p) cos(p) for 0 <= p <= pi/2, without loss of digits at small p."""
    # With e(x) = x - sin(x), the result is e(2p)/2. A Taylor series gives e(2p/9). The formula
    # e(3y) = 3 e(y) + 4 sin^3(y), used twice, then gives e(2p/3) and e(2p).
    third = angle * (2 / 3)
    ninth = third / 3
    square = ninth * ninth
    series = 1 - square / 72 * (1 - square / 110 * (1 - square / 156))
    excess = ninth * square / 6 * (1 - square / 20 * (1 - square / 42 * series))
    return 4.5 * excess + 6 * np.sin(ninth) ** 3 + 2 * np.sin(third) ** 3


def check_elastic(oscillator, damper):
    """Raise the errors of `check_closed_form`, and ValueError if the contact is not elastic."""
    check_closed_form(oscillator, damper)
    if damper.restitution != 1:
        raise ValueError(
            f"restitution = {plain(damper.restitution)}: must be 1, "
            "the harmonic balance of section 2 is for elastic contact"
        )


# A motion counts as marginally stable if its growth rate is from -MARGIN to MARGIN.
MARGIN = 1e-9


def jacobian(state, oscillator, damper, frequency) -> np.ndarray:
    """Return the Jacobian of the slow flow (the paper's appendix A), shape (..., k, k).

    `state` (..., k) holds Re A and Im A, where A = a exp(i t1) is the complex amplitude of Z1. With
    a damper it also holds Re C and Im C, where C is the complex amplitude of Z2.
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
    """Return the largest real part of an eigenvalue of `jacobian` at each state, shape (...)."""
    matrices = jacobian(state, oscillator, damper, frequency)
    return np.max(np.real(np.linalg.eigvals(matrices)), axis=-1)


def fixed_points(solutions) -> np.ndarray:
    """Return real and imaginary parts of each solution's amplitudes, as a `state` of `jacobian`."""
    *sizes, phase = solutions
    return np.stack([size * np.exp(1j * phase) for size in sizes], axis=-1).view(float)


def stability(growth) -> np.ndarray:
    """Return a flag for each growth rate: 1 (stable), -1 (unstable) or 0 (marginal, see MARGIN)."""
    return -np.sign(np.where(np.abs(growth) <= MARGIN, 0.0, growth)).astype(int)


def _push_slopes(loose, damper):
    """Return the contact force's derivatives by C and conj(C). `loose` is C, Z2's amplitude."""
    size = np.abs(loose)
    contact, slope = contact_amplitude(size, damper.clearance)
    size = np.maximum(size, damper.clearance)
    ratio = contact / size
    stiffness = damper.contact_stiffness
    return stiffness * (slope + ratio) / 2, stiffness * (slope - ratio) / 2 * (loose / size) ** 2


def _block(by_value, by_conjugate):
    """Return real 2 x 2 matrices for the linear maps dz -> by_value dz + by_conjugate conj(dz)."""
    total, difference = by_value + by_conjugate, by_value - by_conjugate
    rows = [
        np.stack([total.real, -difference.imag], axis=-1),
        np.stack([total.imag, difference.real], axis=-1),
    ]
    return np.stack(rows, axis=-2)
