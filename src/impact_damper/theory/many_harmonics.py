"""The equations of harmonic balance with any number of harmonics.

`harmonic_solutions` solves these equations. Apart from rounding, their only error is the truncation
of the Fourier series.

Z1, the displacement of the primary mass, and Z2, its displacement relative to the loose mass, are
Fourier series with the base frequency nu = 2 pi/(period of the motion). The penetration of a wall
is f(Z2) = M (Z2 -+ d0), with M = 1 in contact and 0 elsewhere. A contact ends at zero penetration,
so the dashpot term M Z2' is the time derivative of f. The contact force of equations (22) to (24)
is therefore r1 f + c df/dT with c = 2 zc sqrt(r1 rm), and its Fourier coefficient k is (r1 + i k nu
c) times coefficient k of f. f is continuous even where the contact force jumps.

The contacts begin and end at the roots of |Z2| = d0, which are located to rounding. These roots
give the coefficients of M in closed form, and a convolution with M gives the coefficients of f. The
derivative of f with respect to Z2 is M, because f vanishes at both ends of a contact. The contact
force is not sampled and has no aliasing error. The force of the spring, a polynomial of Z1, is
sampled at enough points to be exact. In the alternating frequency-time method (Cameron and Griffin,
J. Appl. Mech. 56, 149, 1989), by contrast, the contact force is sampled too.

Numbers in brackets are equations of the paper.
"""

from dataclasses import dataclass

import numpy as np

from impact_damper.model.bounds import HARMONIC_RANGE, check_count
from impact_damper.model.packed import pack
from impact_damper.model.parameters import SPRING_POWER
from impact_damper.theory import fourier


@dataclass(frozen=True)
class Balance:
    """The equations of harmonic balance for one oscillator, damper and forcing frequency.

    Attributes
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        W, dimensionless.
    highest : int
        N, the highest retained harmonic of the base frequency.
    period : int
        n, period of the motion in forcing cycles; the base frequency is nu = W/n.
    symmetric : bool
        If True, only odd harmonics are retained, for motions with Z(T + half a period) = -Z(T);
        then n and N must be odd. If False, all harmonics from 0 to N are retained.

    Raises
    ------
    TypeError, ValueError
        If a value has the wrong type or is out of range.
    """

    oscillator: object
    damper: object
    frequency: float
    highest: int
    period: int = 1
    symmetric: bool = True

    def __post_init__(self):
        pack(self.oscillator, self.damper, self.frequency)
        check_count("period", self.period, most=1000)
        bounds = HARMONIC_RANGE | {"least": self.period, "why": "the harmonic of the forcing"}
        check_count("highest", self.highest, **bounds)
        if self.symmetric and (self.period % 2 == 0 or self.highest % 2 == 0):
            raise ValueError(
                f"period = {self.period}, highest = {self.highest}: must be odd for a symmetric "
                "motion, which has odd harmonics only"
            )

    @property
    def harmonics(self) -> np.ndarray:
        """Retained harmonics k of the base frequency, shape (m,)."""
        return np.arange(1, self.highest + 1, 2) if self.symmetric else np.arange(self.highest + 1)

    @property
    def rates(self) -> np.ndarray:
        """Factors i k nu by which differentiation multiplies the coefficients, shape (m,)."""
        return 1j * self.harmonics * (self.frequency / self.period)

    @property
    def kept(self) -> np.ndarray:
        """Mask of the real unknowns, without the imaginary part of the mean, which is zero."""
        one = np.concatenate([self.harmonics >= 0, self.harmonics > 0])
        return np.concatenate([one] * (1 if self.damper is None else 2))

    def to_real(self, coefficients) -> np.ndarray:
        """Return the real unknowns of complex coefficients, shape (1 or 2, m).

        Their order is Re Z1, Im Z1, Re Z2, Im Z2.
        """
        return np.hstack([coefficients.real, coefficients.imag]).ravel()[self.kept]

    def to_complex(self, unknowns) -> np.ndarray:
        """Return the complex coefficients, shape (1 or 2, m), of real unknowns from `to_real`."""
        whole = np.zeros(len(self.kept))
        whole[self.kept] = unknowns
        real, imaginary = np.moveaxis(whole.reshape(-1, 2, len(self.harmonics)), 1, 0)
        return real + 1j * imaginary

    def contacts(self, coefficients) -> np.ndarray:
        """Return the contacts in a period as rows of `fourier.intervals`, in the angle nu T.

        The array has the shape (count, 3), with count 0 without a damper.
        """
        if self.damper is None:
            return np.empty((0, 3))
        return fourier.intervals(coefficients[1], self.harmonics, self.damper.clearance)

    def residual(self, coefficients, rows) -> np.ndarray:
        """Return left side minus right side of the equations of motion in each harmonic.

        The equations are (3) and (4), with a dashpot (20) and (21). The result has the shape (1 or
        2, m). The forcing A cos(W T) has the coefficient A/2. `rows` are the `contacts` of the
        coefficients.
        """
        k, rate, own = self.harmonics, self.rates, self.oscillator
        first = coefficients[0]
        count = fourier.product_samples(k, SPRING_POWER)
        bent = np.fft.rfft(own.nonlinear_force(fourier.samples(first, k, count)))[k] / count
        spring = rate**2 + own.damping * rate + own.linear_frequency**2
        forcing = 0.5 * own.forcing_amplitude(self.frequency)
        balance = spring * first + bent - forcing * (k == self.period)
        if self.damper is None:
            return balance[None]
        by_value, by_conjugate = _convolution(self._contact_indicator(rows), k)
        walls = fourier.indicator(rows[rows[:, 0] > 0], k) - fourier.indicator(
            rows[rows[:, 0] < 0], k
        )
        second = coefficients[1]
        force = by_value @ second + by_conjugate @ second.conj() - self.damper.clearance * walls
        force *= self.stiffness
        return np.stack(
            [balance + force, rate**2 * (second - first) + force / self.damper.mass_ratio]
        )

    @property
    def stiffness(self) -> np.ndarray:
        """Dynamic stiffness r1 + i k nu c of the contact spring and dashpot, shape (m,)."""
        return self.damper.contact_stiffness + self.rates * self.damper.dashpot

    def operator(self, coefficients, rows, power=0) -> np.ndarray:
        """Return the real matrix Q0, Q1 or Q2 of the linearised equations, chosen by `power`.

        A disturbance exp(lambda T) p with periodic p obeys (Q0 + lambda Q1 + lambda^2 Q2) p = 0.
        The unknowns p are in the order of `to_real`. Q0 is the Jacobian of `residual`. `rows` are
        the `contacts` of the coefficients.
        """
        k, rate, own = self.harmonics, self.rates, self.oscillator
        unit = np.eye(len(k))
        inertia = (rate**2, 2 * rate, np.ones(len(k)))[power]
        spring = (own.damping * rate + own.linear_frequency**2, own.damping, 0)[power]
        first = _real(unit * (inertia + spring), 0 * unit)
        if power == 0:
            count = fourier.product_samples(k, SPRING_POWER)
            slope = own.nonlinear_slope(fourier.samples(coefficients[0], k, count))
            first += _real(*_convolution(np.fft.rfft(slope) / count, k))
        if self.damper is None:
            return first[np.ix_(self.kept, self.kept)]
        free = _real(unit * inertia, 0 * unit)
        push = np.zeros_like(free)
        if power < 2:
            factor = self.stiffness if power == 0 else np.full(len(k), self.damper.dashpot)
            by_contact = _convolution(self._contact_indicator(rows), k)
            push = _real(*(factor[:, None] * part for part in by_contact))
        whole = np.block([[first, push], [-free, free + push / self.damper.mass_ratio]])
        return whole[np.ix_(self.kept, self.kept)]

    def _contact_indicator(self, rows):
        """Return the Fourier coefficients 0 ... 2N of M, which is 1 in contact and 0 elsewhere."""
        return fourier.indicator(rows, np.arange(2 * self.highest + 1))


def _convolution(coefficients, harmonics):
    """Return matrices A, B: A z + B conj(z) are the retained coefficients of a product g z.

    `coefficients` are g_0 ... g_2N or more. The column of B for the mean of z is zero, because the
    mean is its own conjugate and must count once.
    """
    two_sided = np.concatenate([coefficients[:0:-1].conj(), coefficients])
    zero = len(coefficients) - 1
    column = harmonics[:, None]
    by_conjugate = two_sided[zero + column + harmonics]
    by_conjugate[:, harmonics == 0] = 0
    return two_sided[zero + column - harmonics], by_conjugate


def _real(by_value, by_conjugate):
    """Return the real matrix of dz -> by_value dz + by_conjugate conj(dz), real parts first."""
    total, difference = by_value + by_conjugate, by_value - by_conjugate
    return np.block([[total.real, -difference.imag], [total.imag, difference.real]])
