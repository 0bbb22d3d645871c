r"""Harmonic balance with any number of harmonics, exact but for the truncation.

Z1 and Z2 are Fourier series over the period of the motion. The contact force of equations (22)
to (24) is r1 f(Z2) + c d/dT f(Z2), c = 2 zc sqrt(r1 rm): the dashpot's part M(Z2) Z2' is the
rate of f(Z2), since contact ends at zero penetration. Its coefficient of the harmonic k is
therefore (r1 + i k nu c) times that of f, which is continuous even where the force jumps.

f(Z2) is M (Z2 -+ d0), with M = 1 in contact. Between the ends of the contacts, roots of
|Z2| = d0 that are located to rounding, the coefficients of M are known in closed form, and so
those of f: a convolution. The derivative of f is M alone, as f vanishes at the ends. No force
is sampled, so nothing aliases; the cubic force is, at enough points to be exact.

Compare the alternating frequency-time method: Cameron and Griffin, J. Appl. Mech. 56, 149 (1989).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from impact_damper.system.parameters import check_count, pack
from impact_damper.theory import fourier

TOLERANCE = 1e-11
ITERATIONS = 40
LEAST_DAMPING = 1e-4


@dataclass(frozen=True)
class Balance:
    """The equations of harmonic balance for one oscillator, damper and forcing.

    Attributes
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        W.
    highest : int
        N, the highest harmonic of the period.
    period : int
        Period of the motion in forcing periods, n; the base frequency nu is W/n.
    symmetric : bool
        Odd harmonics only: Z(T + half a period) = -Z(T), for which n must be odd. Else all
        harmonics, the mean included.

    Raises
    ------
    TypeError, ValueError
        If a value is not of its kind or out of range.
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
        check_count("highest", self.highest, least=self.period, most=2**14, why="the forcing's")
        if self.symmetric and (self.period % 2 == 0 or self.highest % 2 == 0):
            raise ValueError(
                f"period = {self.period}, highest = {self.highest}: must be odd for a symmetric "
                "motion, which has odd harmonics only"
            )

    @property
    def harmonics(self) -> np.ndarray:
        """The retained harmonics k of the period, of shape (m,)."""
        return np.arange(1, self.highest + 1, 2) if self.symmetric else np.arange(self.highest + 1)

    @property
    def rates(self) -> np.ndarray:
        """i k nu, which multiplies a coefficient when its series is differentiated."""
        return 1j * self.harmonics * (self.frequency / self.period)

    @property
    def kept(self) -> np.ndarray:
        """Mask of the real unknowns: a mean has no imaginary part."""
        one = np.concatenate([self.harmonics >= 0, self.harmonics > 0])
        return np.concatenate([one] * (1 if self.damper is None else 2))

    def to_real(self, coefficients) -> np.ndarray:
        """Real unknowns of coefficients (1 or 2, m): the real parts of Z1, its imaginary, Z2."""
        return np.hstack([coefficients.real, coefficients.imag]).ravel()[self.kept]

    def to_complex(self, unknowns) -> np.ndarray:
        """Coefficients of the harmonics of Z1 and, with a damper, Z2: (1 or 2, m)."""
        whole = np.zeros(len(self.kept))
        whole[self.kept] = unknowns
        real, imaginary = np.moveaxis(whole.reshape(-1, 2, len(self.harmonics)), 1, 0)
        return real + 1j * imaginary

    def contacts(self, coefficients) -> np.ndarray:
        """Contacts of Z2 as rows of `fourier.intervals`, in the angle nu T; none without damper."""
        if self.damper is None:
            return np.empty((0, 3))
        return fourier.intervals(coefficients[1], self.harmonics, self.damper.clearance)

    def residual(self, coefficients, rows) -> np.ndarray:
        """What is left of (3) and (4), or (20) and (21), harmonic by harmonic; shape (1 or 2, m).

        In units of the forcing, whose own coefficient is 1/2; `rows` are the `contacts`.
        """
        k, rate, own = self.harmonics, self.rates, self.oscillator
        first = coefficients[0]
        count = fourier.product_samples(k, 3)
        cube = np.fft.rfft(fourier.samples(first, k, count) ** 3)[k] / count
        spring = rate**2 + own.damping * rate + own.linear_frequency**2
        balance = spring * first + cube - 0.5 * (k == self.period)
        if self.damper is None:
            return balance[None]
        by_value, by_conjugate = _convolution(self._contact_share(rows), k)
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
        """r1 + i k nu c, the contact's stiffness with its dashpot."""
        return self.damper.contact_stiffness + self.rates * self.damper.dashpot

    def operator(self, coefficients, rows, power=0) -> np.ndarray:
        """Linearised equations as a real matrix of `to_real` unknowns.

        A disturbance exp(lambda T) p, p periodic, obeys (Q0 + lambda Q1 + lambda^2 Q2) p = 0;
        `power` chooses the Q. Q0 is the Jacobian of `residual`; `rows` are the `contacts`.
        """
        k, rate, own = self.harmonics, self.rates, self.oscillator
        unit = np.eye(len(k))
        inertia = (rate**2, 2 * rate, np.ones(len(k)))[power]
        spring = (own.damping * rate + own.linear_frequency**2, own.damping, 0)[power]
        first = _real(unit * (inertia + spring), 0 * unit)
        if power == 0:
            count = fourier.product_samples(k, 3)
            square = np.fft.rfft(3 * fourier.samples(coefficients[0], k, count) ** 2) / count
            first += _real(*_convolution(square, k))
        if self.damper is None:
            return first[np.ix_(self.kept, self.kept)]
        free = _real(unit * inertia, 0 * unit)
        push = np.zeros_like(free)
        if power < 2:
            factor = self.stiffness if power == 0 else np.full(len(k), self.damper.dashpot)
            share = _convolution(self._contact_share(rows), k)
            push = _real(*(factor[:, None] * part for part in share))
        whole = np.block([[first, push], [-free, free + push / self.damper.mass_ratio]])
        return whole[np.ix_(self.kept, self.kept)]

    def _contact_share(self, rows):
        """Coefficients 0 ... 2N of M, which is 1 in contact."""
        return fourier.indicator(rows, np.arange(2 * self.highest + 1))


class Solution(NamedTuple):
    """A solution of the balance, or where the search for one ended.

    Attributes
    ----------
    balance : Balance
    coefficients : numpy.ndarray, shape (1 or 2, m)
        Two-sided Fourier coefficients of Z1 and, with a damper, Z2.
    status : str
        "converged", "stalled" (no damped step reduces the next one), or "iteration_limit".
    iterations : int
        Steps of Newton's method.
    residual : float
        Largest entry of the residual.
    """

    balance: Balance
    coefficients: np.ndarray
    status: str
    iterations: int
    residual: float


def solve(balance, start, iterations=ITERATIONS) -> Solution:
    """Damped Newton's method for the balance, from coefficients of any number of harmonics.

    A step is halved until the next one, by the same Jacobian, is shorter (the natural
    monotonicity test of Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 3.3): the
    residual itself, ruled by the stiff contact, is a poor guide. It has converged
    when a step changes no coefficient by more than 1e-11 of the largest.

    Parameters
    ----------
    balance : Balance
    start : array, shape (1 or 2, any)
        Coefficients of the first harmonics; the others begin at zero.
    iterations : int
        Steps allowed.
    """
    count = len(balance.harmonics)
    now = np.zeros((len(start), count), complex)
    now[:, : start.shape[1]] = start[:, :count]
    rows = balance.contacts(now)
    defect = balance.to_real(balance.residual(now, rows))
    status, taken = "iteration_limit", 0
    while taken < iterations and status == "iteration_limit":
        factors = lu_factor(balance.operator(now, rows), check_finite=False)
        step = -lu_solve(factors, defect, check_finite=False)
        small = np.max(np.abs(step)) <= TOLERANCE * np.max(np.abs(now))
        taken += 1
        damping = 1.0
        while damping >= LEAST_DAMPING:
            trial = now + damping * balance.to_complex(step)
            rows = balance.contacts(trial)
            left = balance.to_real(balance.residual(trial, rows))
            following = lu_solve(factors, left, check_finite=False)
            if small or np.linalg.norm(following) <= (1 - damping / 4) * np.linalg.norm(step):
                now, defect = trial, left
                status = "converged" if small else status
                break
            damping /= 2
        else:
            status = "stalled"
    return Solution(balance, now, status, taken, float(np.max(np.abs(defect))))


def _convolution(coefficients, harmonics):
    """Matrices that take z and conj(z) to the retained coefficients of a product g z.

    `coefficients` are g_0 ... g_2N at least; the mean of z counts once.
    """
    two_sided = np.concatenate([coefficients[:0:-1].conj(), coefficients])
    zero = len(coefficients) - 1
    column = harmonics[:, None]
    by_conjugate = two_sided[zero + column + harmonics]
    by_conjugate[:, harmonics == 0] = 0
    return two_sided[zero + column - harmonics], by_conjugate


def _real(by_value, by_conjugate):
    """Real matrix of the map dz -> by_value dz + by_conjugate conj(dz), real parts first."""
    total, difference = by_value + by_conjugate, by_value - by_conjugate
    return np.block([[total.real, -difference.imag], [total.imag, difference.real]])
