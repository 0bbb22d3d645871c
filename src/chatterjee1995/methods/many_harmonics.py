"""Harmonic balance with any number of harmonics, and Newton's method for its equations."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from chatterjee1995.methods import fourier
from impact_damper.kernel.equation import spring, spring_slope
from impact_damper.model.exit_rules import ZERO_PENETRATION
from impact_damper.model.packed import pack
from impact_damper.model.parameters import SPRING_POWER, check_closed_form
from impact_damper.theory import single_harmonic
from impact_damper.theory.free_oscillator import main_solutions


@dataclass(frozen=True)
class Balance:
    """Equations of harmonic balance for a symmetric motion, which has odd harmonics only."""

    oscillator: object
    damper: object
    frequency: float
    highest: int

    def __post_init__(self):
        if self.damper is not None:
            check_closed_form(self.oscillator, self.damper)
            if self.damper.exit_rule != ZERO_PENETRATION:
                raise ValueError(
                    f"exit_rule = {self.damper.exit_rule}: must be {ZERO_PENETRATION} in harmonic "
                    "balance"
                )

    @property
    def harmonics(self) -> np.ndarray:
        """The harmonics 1, 3, 5, ... up to `highest`."""
        return np.arange(1, self.highest + 1, 2)

    @cached_property
    def packed(self) -> np.ndarray:
        """Packed parameters of the oscillator without a damper."""
        return pack(self.oscillator, None, self.frequency)

    @property
    def rates(self) -> np.ndarray:
        """Factors i k W by which d/dT multiplies the coefficients of the harmonics k."""
        return 1j * self.harmonics * self.frequency

    @property
    def unknowns(self) -> int:
        """Number of unknowns, the real and imaginary parts of all coefficients."""
        return len(self.harmonics) * (2 if self.damper is None else 4)

    def to_real(self, coefficients) -> np.ndarray:
        """Return coefficients in a real vector: Re Z1, Im Z1, and with a damper Re Z2, Im Z2."""
        return np.hstack([coefficients.real, coefficients.imag]).ravel()

    def to_complex(self, unknowns) -> np.ndarray:
        """Return the coefficients that `to_real` has put into a real vector."""
        parts = unknowns.reshape(-1, 2, len(self.harmonics))
        return parts[:, 0] + 1j * parts[:, 1]

    def contacts(self, coefficients) -> np.ndarray:
        """Return a row (wall, begin, end) for each contact in a cycle. Both ends are phases W T."""
        if self.damper is None:
            return np.empty((0, 3))
        return fourier.intervals(coefficients[1], self.harmonics, self.damper.clearance)

    def residual(self, coefficients, rows) -> np.ndarray:
        """Return left minus right sides of the equations of motion. `rows` is from `contacts`."""
        k, rate, own = self.harmonics, self.rates, self.oscillator
        first = coefficients[0]
        count = fourier.product_samples(k, SPRING_POWER)
        pull = spring.py_func(self.packed, fourier.samples(first, k, count))
        restoring = np.fft.rfft(pull)[k] / count
        forcing = 0.5 * own.forcing_amplitude(self.frequency)
        balance = (rate**2 + own.damping * rate) * first + restoring - forcing * (k == 1)
        if self.damper is None:
            return balance[None]
        by_value, by_conjugate = _convolution(self._contact_indicator(rows), k)
        above, below = (fourier.indicator(rows[rows[:, 0] == wall], k) for wall in (1, -1))
        walls = above - below
        second = coefficients[1]
        force = by_value @ second + by_conjugate @ second.conj() - self.damper.clearance * walls
        force *= self.stiffness
        return np.stack(
            [balance + force, rate**2 * (second - first) + force / self.damper.mass_ratio]
        )

    @property
    def stiffness(self) -> np.ndarray:
        """Dynamic stiffness of a wall, a spring with a dashpot, for each harmonic."""
        return self.damper.contact_stiffness + self.rates * self.damper.dashpot

    def operator(self, coefficients, rows, power=0) -> np.ndarray:
        """Return the real matrix Q0, Q1 or Q2 of the linearised equations, for `power` 0, 1 or 2.

        A disturbance exp(lambda T) p with periodic p obeys (Q0 + lambda Q1 + lambda^2 Q2) p = 0.
        The unknowns of p have the order of `to_real`. Q0 is the Jacobian of `residual`.
        """
        k, rate, own = self.harmonics, self.rates, self.oscillator
        unit = np.eye(len(k))
        inertia = (rate**2, 2 * rate, np.ones(len(k)))[power]
        drag = (own.damping * rate, own.damping, 0)[power]
        first = _real(unit * (inertia + drag), 0 * unit)
        if power == 0:
            count = fourier.product_samples(k, SPRING_POWER)
            slope = spring_slope.py_func(self.packed, fourier.samples(coefficients[0], k, count))
            first += _real(*_convolution(np.fft.rfft(slope) / count, k))
        if self.damper is None:
            return first
        free = _real(unit * inertia, 0 * unit)
        push = np.zeros_like(free)
        if power < 2:
            factor = self.stiffness if power == 0 else np.full(len(k), self.damper.dashpot)
            by_contact = _convolution(self._contact_indicator(rows), k)
            push = _real(*(factor[:, None] * part for part in by_contact))
        return np.block([[first, push], [-free, free + push / self.damper.mass_ratio]])

    def _contact_indicator(self, rows):
        return fourier.indicator(rows, np.arange(2 * self.highest + 1))


def _convolution(coefficients, harmonics):
    two_sided = np.concatenate([coefficients[:0:-1].conj(), coefficients])
    zero = len(coefficients) - 1
    column = harmonics[:, None]
    return two_sided[zero + column - harmonics], two_sided[zero + column + harmonics]


def _real(by_value, by_conjugate):
    """Return the real matrix that maps (Re z, Im z) as z -> by_value z + by_conjugate conj(z)."""
    total, difference = by_value + by_conjugate, by_value - by_conjugate
    return np.block([[total.real, -difference.imag], [total.imag, difference.real]])


# Newton's method has converged if max |change| <= TOLERANCE * max |coefficient|. It takes at most
# ITERATIONS steps. LEAST_DAMPING is the smallest factor by which it multiplies a step.
TOLERANCE, ITERATIONS, LEAST_DAMPING = 1e-11, 40, 1e-4


class Solution(NamedTuple):
    """Result of Newton's method. Row 0 of `coefficients` belongs to Z1, row 1 (if any) to Z2.

    The status is "converged", "iteration_limit", or "stalled" if even the shortest step fails.
    """

    balance: Balance
    coefficients: np.ndarray
    status: str
    iterations: int


def solve(balance, start) -> Solution:
    """Solve the equations of a balance by damped Newton's method, from coefficients `start`.

    The natural monotonicity test (Deuflhard, Newton Methods for Nonlinear Problems, 2004, section
    3.3) decides whether to halve a step. Stiff contacts would dominate a test of the residual.
    """
    count = len(balance.harmonics)
    now = np.zeros((len(start), count), complex)
    now[:, : start.shape[1]] = start[:, :count]
    rows = balance.contacts(now)
    defect = balance.to_real(balance.residual(now, rows))
    status, taken = "iteration_limit", 0
    while taken < ITERATIONS and status == "iteration_limit":
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
    return Solution(balance, now, status, taken)


def single_term(oscillator, damper, frequency) -> np.ndarray:
    """Return coefficients of a solution of (7): the smallest with a damper, the largest without."""
    if damper is None:
        free = main_solutions(oscillator, frequency)
        return free.amplitude[-1:, None] * np.exp(1j * free.phase[-1]) / 2
    elastic = replace(damper, restitution=1.0)
    found = single_harmonic.impacting_solutions(oscillator, elastic, frequency)
    if not len(found.amplitude):
        raise ArithmeticError(f"frequency = {frequency:g}: (7) has no solution with contacts")
    least = np.argmin(np.abs(found.amplitude))
    sizes = np.array([[found.amplitude[least]], [found.relative_amplitude[least]]])
    return sizes * np.exp(1j * found.phase[least]) / 2


def refine(balances, start) -> list:
    """Solve each balance, at first from `start`, then from the last solution that converged."""
    solutions = []
    for balance in balances:
        solutions.append(solve(balance, start))
        if solutions[-1].status == "converged":
            start = solutions[-1].coefficients
    return solutions


def state_of(solution) -> np.ndarray:
    """Return Z1, Z1', Z2, Z2' of a `Solution` at W T = pi/2. Without a damper Z2 is Z1."""
    balance = solution.balance
    state = [
        fourier.value(each, balance.harmonics, np.pi / 2, order) * balance.frequency**order
        for each in solution.coefficients
        for order in (0, 1)
    ]
    return np.array(state if len(state) == 4 else 2 * state)
