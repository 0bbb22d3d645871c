"""Harmonic balance with any number of harmonics; truncation is its only error beside rounding.

Z1 (displacement of the primary mass) and Z2 (that relative to the loose mass) are Fourier series
with the base frequency nu = 2 pi/(period of the motion). The contact force of equations (22) to
(24) is r1 f(Z2) + c d/dT f(Z2) with c = 2 zc sqrt(r1 rm): contact ends at zero penetration, so the
dashpot term M(Z2) Z2' is the time derivative of f(Z2). The Fourier coefficient k of the force is
therefore (r1 + i k nu c) times that of f. f is continuous even where the force jumps.

f(Z2) = M (Z2 -+ d0) is the penetration, with M = 1 in contact and 0 elsewhere. The ends of the
contacts are the roots of |Z2| = d0, located to rounding. They give the coefficients of M in closed
form, and a convolution gives those of f. The derivative of f with respect to Z2 is M, since f
vanishes at the ends. The contact force is not sampled, so it has no aliasing error; the cubic force
is sampled at enough points to be exact.

Compare the alternating frequency-time method: Cameron and Griffin, J. Appl. Mech. 56, 149 (1989).
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from impact_damper.system.bounds import HARMONIC_RANGE, check_count
from impact_damper.system.packed import pack
from impact_damper.theory import fourier, single_harmonic
from impact_damper.theory.free_oscillator import main_solutions

# Newton's method: largest change of a coefficient on convergence, relative to the largest
# coefficient; most steps; smallest factor by which a step is shortened.
TOLERANCE = 1e-11
ITERATIONS = 40
LEAST_DAMPING = 1e-4


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
        n, period of the motion in forcing periods; the base frequency is nu = W/n.
    symmetric : bool
        True: odd harmonics only, for motions with Z(T + half a period) = -Z(T); n and N must be
        odd. False: all harmonics from 0 to N.

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
        bounds = HARMONIC_RANGE | {"least": self.period, "why": "the forcing's"}
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
        """i k nu, by which differentiation multiplies each coefficient, shape (m,)."""
        return 1j * self.harmonics * (self.frequency / self.period)

    @property
    def kept(self) -> np.ndarray:
        """Mask of the real unknowns: excludes the imaginary part of the mean, which is zero."""
        one = np.concatenate([self.harmonics >= 0, self.harmonics > 0])
        return np.concatenate([one] * (1 if self.damper is None else 2))

    def to_real(self, coefficients) -> np.ndarray:
        """Real unknowns of complex coefficients (1 or 2, m).

        In the order Re Z1, Im Z1, Re Z2, Im Z2.
        """
        return np.hstack([coefficients.real, coefficients.imag]).ravel()[self.kept]

    def to_complex(self, unknowns) -> np.ndarray:
        """Complex coefficients, shape (1 or 2, m), of real unknowns: inverse of `to_real`."""
        whole = np.zeros(len(self.kept))
        whole[self.kept] = unknowns
        real, imaginary = np.moveaxis(whole.reshape(-1, 2, len(self.harmonics)), 1, 0)
        return real + 1j * imaginary

    def contacts(self, coefficients) -> np.ndarray:
        """Contacts in a period, rows of `fourier.intervals` in the angle nu T.

        Shape (count, 3), with count 0 without a damper.
        """
        if self.damper is None:
            return np.empty((0, 3))
        return fourier.intervals(coefficients[1], self.harmonics, self.damper.clearance)

    def residual(self, coefficients, rows) -> np.ndarray:
        """Residual of (3) and (4), with a dashpot of (20) and (21), in each harmonic.

        Left side minus right side, shape (1 or 2, m); the forcing f cos(W T) has the coefficient
        f/2. `rows` are the `contacts` of the coefficients.
        """
        k, rate, own = self.harmonics, self.rates, self.oscillator
        first = coefficients[0]
        count = fourier.product_samples(k, 3)
        cube = np.fft.rfft(own.cubic * fourier.samples(first, k, count) ** 3)[k] / count
        spring = rate**2 + own.damping * rate + own.linear_frequency**2
        forcing = 0.5 * own.forcing_amplitude(self.frequency)
        balance = spring * first + cube - forcing * (k == self.period)
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
        """r1 + i k nu c, dynamic stiffness of the contact spring and dashpot, shape (m,)."""
        return self.damper.contact_stiffness + self.rates * self.damper.dashpot

    def operator(self, coefficients, rows, power=0) -> np.ndarray:
        """Real matrix Q0, Q1 or Q2 (`power`) of the linearised equations, in `to_real` unknowns.

        A disturbance exp(lambda T) p with periodic p obeys (Q0 + lambda Q1 + lambda^2 Q2) p = 0.
        Q0 is the Jacobian of `residual`. `rows` are the `contacts` of the coefficients.
        """
        k, rate, own = self.harmonics, self.rates, self.oscillator
        unit = np.eye(len(k))
        inertia = (rate**2, 2 * rate, np.ones(len(k)))[power]
        spring = (own.damping * rate + own.linear_frequency**2, own.damping, 0)[power]
        first = _real(unit * (inertia + spring), 0 * unit)
        if power == 0:
            count = fourier.product_samples(k, 3)
            slope = 3 * own.cubic * fourier.samples(coefficients[0], k, count) ** 2
            first += _real(*_convolution(np.fft.rfft(slope) / count, k))
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
        """Fourier coefficients 0 ... 2N of M, which is 1 in contact and 0 elsewhere."""
        return fourier.indicator(rows, np.arange(2 * self.highest + 1))


class Solution(NamedTuple):
    """Last iterate of Newton's method for a balance: a solution if the status is "converged".

    Attributes
    ----------
    balance : Balance
    coefficients : numpy.ndarray of complex, shape (2, m)
        Fourier coefficients c_k, k >= 0, of Z1 and Z2 (see `fourier`). Without a damper of Z1
        only, shape (1, m).
    status : str
        "converged"; "stalled" if no shortened step makes the following step shorter; or
        "iteration_limit".
    iterations : int
        Steps of Newton's method taken.
    residual : float
        Largest absolute entry of the real residual.
    """

    balance: Balance
    coefficients: np.ndarray
    status: str
    iterations: int
    residual: float


def solve(balance, start, iterations=ITERATIONS) -> Solution:
    """Solve a balance by damped Newton's method, from an approximation with any harmonics.

    A step is halved until the following step, computed with the same Jacobian, is shorter: the
    natural monotonicity test of Deuflhard, Newton Methods for Nonlinear Problems, 2004, section
    3.3. The residual would be a poor measure, since the stiff contact dominates it. The method
    has converged when a step changes no coefficient by more than 1e-11 of the largest one.

    Parameters
    ----------
    balance : Balance
    start : array, shape (1 or 2, any)
        Coefficients of the lowest retained harmonics; all higher ones start at zero.
    iterations : int
        Number of steps allowed.

    Returns
    -------
    Solution
    """
    count = len(balance.harmonics)
    now = np.zeros((len(start), count), complex)
    now[:, : start.shape[1]] = start[:, :count]
    rows = balance.contacts(now)
    defect = balance.to_real(balance.residual(now, rows))
    status, taken = "iteration_limit", 0
    while taken < iterations and status == "iteration_limit":
        factors = factorised(balance.operator(now, rows))
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


def factorised(matrix):
    """Return the LU factors of a matrix for `scipy.linalg.lu_solve`.

    They are computed in another thread, so that Ctrl-C is heard at once: with a thousand harmonics
    the computation takes seconds.
    """
    pool = ThreadPoolExecutor(1)
    try:
        return pool.submit(lu_factor, matrix, check_finite=False).result()
    finally:
        pool.shutdown(wait=False)


def _convolution(coefficients, harmonics):
    """Matrices A, B such that A z + B conj(z) are the retained coefficients of a product g z.

    `coefficients` are g_0 ... g_2N or more. The column of B for the mean of z is zero, since the
    mean must count once.
    """
    two_sided = np.concatenate([coefficients[:0:-1].conj(), coefficients])
    zero = len(coefficients) - 1
    column = harmonics[:, None]
    by_conjugate = two_sided[zero + column + harmonics]
    by_conjugate[:, harmonics == 0] = 0
    return two_sided[zero + column - harmonics], by_conjugate


def _real(by_value, by_conjugate):
    """Real matrix of dz -> by_value dz + by_conjugate conj(dz), with real parts first."""
    total, difference = by_value + by_conjugate, by_value - by_conjugate
    return np.block([[total.real, -difference.imag], [total.imag, difference.real]])


def single_term(oscillator, damper, frequency) -> np.ndarray:
    """Return the coefficients of a single-term solution, the first guess for more harmonics.

    With a damper, taken as elastic, this is the solution of equation (7) with the least |a|;
    without a damper the solution with the greatest |a| on the curve through the peak.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        W, dimensionless.

    Returns
    -------
    numpy.ndarray, shape (2, 1) with a damper, else (1, 1)
        Complex Fourier coefficients of the first harmonic of Z1 and Z2.

    Raises
    ------
    ArithmeticError
        If (7) has no solution with contacts.
    ValueError
        Without a damper, as in `free_oscillator.main_solutions`.
    """
    if damper is None:
        found = main_solutions(oscillator, frequency)
        sizes = found.amplitude[-1:]
        phase = found.phase[-1]
    else:
        found = single_harmonic.impacting_solutions(
            oscillator, replace(damper, restitution=1.0), frequency
        )
        if not len(found.amplitude):
            raise ArithmeticError(f"frequency = {frequency:g}: (7) has no solution with contacts")
        least = np.argmin(np.abs(found.amplitude))
        sizes = np.array([found.amplitude[least], found.relative_amplitude[least]])
        phase = found.phase[least]
    return sizes[:, None] * np.exp(1j * phase) / 2


def refine(balances, start) -> list:
    """Return a `Solution` of each balance; its first guess is the last solution that converged.

    Parameters
    ----------
    balances : list of Balance
        In the order of increasing numbers of harmonics.
    start : numpy.ndarray
        Coefficients that are the first guess for the first balance, as from `single_term`.
    """
    solutions = []
    for balance in balances:
        solutions.append(solve(balance, start))
        if solutions[-1].status == "converged":
            start = solutions[-1].coefficients
    return solutions


def state_of(solution) -> np.ndarray:
    """Return Z1, Z1', Z2, Z2' of a `Solution` at W T = pi/2; without a damper Z2 = Z1."""
    balance = solution.balance
    state = [
        fourier.value(each, balance.harmonics, np.pi / 2, order) * balance.frequency**order
        for each in solution.coefficients
        for order in (0, 1)
    ]
    return np.array(state if len(state) == 4 else 2 * state)
