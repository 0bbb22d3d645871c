"""Single-term harmonic balance of section 2.1: Z1 = a cos(W T + t1), Z2 = b cos(W T + t2).

Equation (6d) makes t2 = t1 when the sign of a is left free: a < 0 is the set in
which Z1 and Z2 are in antiphase. b > 0 is no restriction, for a change of sign of
a and b together is a shift of t1 by half a period.

The balance holds for elastic contact; every quantity is dimensionless.
"""

from typing import NamedTuple

import numpy as np
from scipy.optimize import brentq

from impact_damper.system.bounds import plain
from impact_damper.system.parameters import check_damper, check_frequency
from impact_damper.theory.roots import polynomial_roots, smooth_roots


class Solutions(NamedTuple):
    """Solutions of the balance at one frequency, arrays of shape (count,).

    Attributes
    ----------
    amplitude : numpy.ndarray
        a, amplitude of Z1, negative in antiphase to Z2.
    relative_amplitude : numpy.ndarray
        b > 0, amplitude of Z2.
    phase : numpy.ndarray
        t1 in (-pi, pi], phase to the forcing.
    """

    amplitude: np.ndarray
    relative_amplitude: np.ndarray
    phase: np.ndarray


class FreeSolutions(NamedTuple):
    """Motions without the damper at one frequency: a > 0 and t1, arrays of shape (count,)."""

    amplitude: np.ndarray
    phase: np.ndarray


class RigidSolutions(NamedTuple):
    """Solutions for rigid walls (r1 to infinity, b = d0), arrays of shape (count,).

    Attributes
    ----------
    tangent : numpy.ndarray
        D = tan(t1/2), a root of (14).
    amplitude, phase : numpy.ndarray
        a and t1 as in `Solutions`.
    pulling : numpy.ndarray of bool
        True where a > d0: the walls would have to pull, so (7) has no such solution.
    residual : numpy.ndarray
        What is left of (13a).
    """

    tangent: np.ndarray
    amplitude: np.ndarray
    phase: np.ndarray
    pulling: np.ndarray
    residual: np.ndarray


def contact_amplitude(relative_amplitude, clearance) -> tuple:
    """First harmonic B of the contact force over r1, and dB/db, equation (6e).

    With d0/b = cos(p) they are b (2/pi)(p - sin p cos p) and (2/pi)(p + sin p cos p);
    both are zero where b <= d0.

    Parameters
    ----------
    relative_amplitude : float or array_like
        b >= 0.
    clearance : float
        d0.

    Returns
    -------
    tuple of numpy.ndarray
        B and dB/db, shaped as `relative_amplitude`.
    """
    amplitude = np.maximum(relative_amplitude, clearance)
    angle = np.arctan2(np.sqrt((amplitude - clearance) * (amplitude + clearance)), clearance)
    slope = (2 / np.pi) * (angle + np.sin(angle) * np.cos(angle))
    return amplitude * (2 / np.pi) * _excess(angle), slope


def rigid_solutions(oscillator, damper, frequency) -> RigidSolutions:
    """All real roots of (14), ascending, and what they mean in (13).

    Raises
    ------
    ValueError
        If the contact is not elastic, or the frequency out of range.
    """
    check_elastic(damper)
    frequency = check_frequency(frequency)
    inertia = damper.mass_ratio * frequency**2
    detuning = oscillator.linear_frequency**2 - frequency**2
    drag = oscillator.damping * frequency
    odd = -2 / drag * (detuning - inertia)
    cubic = -6 / drag**3
    push = inertia * damper.clearance
    tangent = polynomial_roots(
        [push - 1, odd, 3 * push - 1, cubic + 2 * odd, 3 * push + 1, odd, push + 1]
    )
    amplitude = -2 * tangent / (drag * (1 + tangent**2))
    phase = 2 * np.arctan(tangent)
    residual = (
        amplitude * (detuning + 0.75 * amplitude**2)
        + inertia * (damper.clearance - amplitude)
        - np.cos(phase)
    )
    return RigidSolutions(tangent, amplitude, phase, amplitude > damper.clearance, residual)


def impacting_solutions(oscillator, damper, frequency) -> Solutions:
    """All solutions of (7) with (6e), by ascending contact angle p, where d0/b = cos(p).

    (7c) gives a(p) = (d0/cos p)(1 - k (p - sin p cos p)), k = 2 r1/(pi rm W^2), and
    (7a, b) leave one equation for p after t1 is eliminated:

        G(p) = (a wl^2 - a W^2 + (3/4) a^3 + rm W^2 (b - a))^2 + (h a W)^2 - 1 = 0.

    cos^6(p) G(p) is an entire function, and (7b) bounds |a| and so p. Its count of roots
    is certain to rounding: between neighbouring extrema there is one root or none, by
    the signs there (see `smooth_roots`).

    Raises
    ------
    ValueError
        If the contact is not elastic, or the frequency not positive.
    ArithmeticError
        If G could not be resolved.
    """
    balance = _Balance(oscillator, damper, check_frequency(frequency))
    lower, upper = balance.angle_range()
    if not lower < upper:
        return Solutions(*np.empty((3, 0)))
    angle = smooth_roots(balance.defect, balance.defect_size, lower, upper)
    cosine, scaled, inline, quadrature = balance.terms(angle)
    return Solutions(scaled / cosine, damper.clearance / cosine, np.arctan2(-quadrature, inline))


def resting_solutions(oscillator, damper, frequency) -> Solutions:
    """Motions that touch no wall, the loose mass at rest: the free ones with |a| < d0."""
    check_damper(damper)
    free = free_solutions(oscillator, frequency)
    inside = free.amplitude < damper.clearance
    return Solutions(free.amplitude[inside], free.amplitude[inside], free.phase[inside])


def free_solutions(oscillator, frequency) -> FreeSolutions:
    """All motions without the damper, by ascending amplitude a > 0: roots of a cubic in a^2."""
    detuning = oscillator.linear_frequency**2 - check_frequency(frequency) ** 2
    drag = oscillator.damping * frequency
    squares = polynomial_roots([-1, detuning**2 + drag**2, 1.5 * detuning, 0.5625])
    amplitude = np.sqrt(squares)
    inline = amplitude * (detuning + 0.75 * squares)
    return FreeSolutions(amplitude, np.arctan2(-drag * amplitude, inline))


class Point(NamedTuple):
    """A point of the free response curve: W and a."""

    frequency: float
    amplitude: float


def maximum_response(oscillator) -> Point:
    """Exact maximum of the free response curve over W.

    The cubic for a is a quadratic in W^2 with the roots m - h^2/2 +- sqrt(1/a^2 - h^2 m
    + h^4/4), m = wl^2 + (3/4) a^2; they meet at the maximum.

    Raises
    ------
    ValueError
        If the damping is so large that the curve falls from W = 0 on.
    """
    damping, stiffness = oscillator.damping**2, oscillator.linear_frequency**2
    linear = damping * (stiffness - damping / 4)
    amplitude = (-linear + np.sqrt(linear**2 + 3 * damping)) / (1.5 * damping)
    square = stiffness + 0.75 * amplitude - damping / 2
    if square <= 0:
        raise ValueError(f"damping = {oscillator.damping:g}: too large, the response has no peak")
    return Point(float(np.sqrt(square)), float(np.sqrt(amplitude)))


def free_folds(oscillator) -> list[Point]:
    """Folds of the free response curve, by ascending amplitude; none or two.

    On the branch W^2 = m - h^2/2 + S of `maximum_response`, S its root, dW/da = 0 asks for
    (3/2) S = 1/u^2 + (3/4) h^2, u = a^2, which is a polynomial of degree five in u.
    """
    damping, stiffness = oscillator.damping**2, oscillator.linear_frequency**2
    squares = polynomial_roots(
        [1, 0, 1.5 * damping, -2.25, 2.25 * damping * stiffness, 1.6875 * damping]
    )
    squares = squares[squares > 0]
    frequencies = stiffness + 0.75 * squares - damping / 2 + (1 / squares**2 + 0.75 * damping) / 1.5
    return [
        Point(float(np.sqrt(square)), float(np.sqrt(u)))
        for square, u in zip(frequencies, squares, strict=True)
        if square > 0
    ]


class _Balance:
    """(7) with (6e) as functions of the contact angle p; each term is multiplied by cos^3(p)."""

    def __init__(self, oscillator, damper, frequency):
        check_elastic(damper)
        self.clearance = damper.clearance
        self.detuning = oscillator.linear_frequency**2 - frequency**2
        self.drag = oscillator.damping * frequency
        self.inertia = damper.mass_ratio * frequency**2
        self.stiffness = 2 * damper.contact_stiffness / (np.pi * self.inertia)

    def terms(self, angle):
        """cos(p), a cos(p), and cos(t1) and -sin(t1) of (7a, b) times cos^3(p)."""
        cosine = np.cos(angle)
        scaled = self.scaled_amplitude(angle)
        force = self.inertia * (self.clearance - scaled)
        inline = scaled * (self.detuning * cosine**2 + 0.75 * scaled**2) + force * cosine**2
        return cosine, scaled, inline, self.drag * scaled * cosine**2

    def scaled_amplitude(self, angle):
        """a cos(p) of (7c)."""
        return self.clearance * (1 - self.stiffness * _excess(angle))

    def defect(self, angle):
        """cos^6(p) G(p)."""
        cosine, _, inline, quadrature = self.terms(angle)
        return inline**2 + quadrature**2 - cosine**6

    def defect_size(self, angle):
        """Rounding error of `defect` in units of the machine's; that of a cos(p) counts most."""
        cosine, scaled, inline, quadrature = self.terms(angle)
        square = cosine**2
        error = 2 * self.clearance - scaled
        inline_error = error * ((abs(self.detuning) + self.inertia) * square + 2.25 * scaled**2)
        return (
            2 * np.abs(inline) * inline_error
            + 2 * np.abs(quadrature) * self.drag * error * square
            + inline**2
            + quadrature**2
            + square**3
        )

    def angle_range(self):
        """Least and greatest p that (7a, b) allow; equal if they allow none.

        (7b) bounds |a| by 1/(h W), and (7a) bounds (3/4) |a|^3 by its other terms.
        """
        reach = 1 / self.drag
        lower, upper = self._angles_within(reach)
        constant = 1 + self.inertia * self.clearance / np.cos(upper)
        slope = abs(self.detuning) + self.inertia
        bound = max(np.sqrt(slope / 0.375), np.cbrt(constant / 0.375))
        return self._angles_within(bound) if bound < reach else (lower, upper)

    def _angles_within(self, reach):
        """Range of p that holds every |a| <= reach.

        a cos(p) + reach cos(p) falls with p; a cos(p) - reach cos(p) rises, then falls.
        """
        reach *= 1 + 1e-6
        largest = reach + (1 + reach * (abs(self.detuning) + 0.75 * reach**2)) / self.inertia
        last = np.arccos(min(1, self.clearance / largest))

        def above(angle, amplitude):
            return self.scaled_amplitude(angle) - amplitude * np.cos(angle)

        if above(last, -reach) < 0:
            last = brentq(above, 0, last, args=(-reach,))
        if self.clearance <= reach:
            return 0.0, last
        return (brentq(above, 0, last, args=(reach,)) if above(last, reach) < 0 else last), last


def _excess(angle):
    """p - sin(p) cos(p) for 0 <= p <= pi/2 without cancellation.

    It is half of e(2p), e(x) = x - sin(x): the series of e serves at 2p/9, and
    e(3y) = 3 e(y) + 4 sin^3(y) leads back from there.
    """
    third = angle * (2 / 3)
    ninth = third / 3
    square = ninth * ninth
    series = 1 - square / 72 * (1 - square / 110 * (1 - square / 156))
    excess = ninth * square / 6 * (1 - square / 20 * (1 - square / 42 * series))
    return 4.5 * excess + 6 * np.sin(ninth) ** 3 + 2 * np.sin(third) ** 3


def check_elastic(damper):
    check_damper(damper)
    if damper.restitution != 1:
        raise ValueError(
            f"restitution = {plain(damper.restitution)}: must be 1, "
            "the harmonic balance of section 2 is for elastic contact"
        )
