"""Solve the equations of harmonic balance of `many_harmonics` by Newton's method.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass, W the
forcing frequency, and T the time. Numbers in brackets are equations of the paper.
"""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from impact_damper.theory import fourier, single_harmonic
from impact_damper.theory.free_oscillator import main_solutions
from impact_damper.theory.many_harmonics import Balance

# Newton's method (`solve`):
# TOLERANCE      largest change of a coefficient in the last step, relative to the largest one
# ITERATIONS     largest number of steps
# LEAST_DAMPING  smallest factor by which a step is multiplied
TOLERANCE = 1e-11
ITERATIONS = 40
LEAST_DAMPING = 1e-4


class Solution(NamedTuple):
    """Last iterate of Newton's method, which is a solution if the status is "converged".

    Attributes
    ----------
    balance : Balance
    coefficients : numpy.ndarray of complex, shape (2, m)
        Fourier coefficients c_k, k >= 0, of Z1 and Z2 (see `fourier`). Without a damper the
        coefficients of Z1 only, shape (1, m).
    status : str
        "converged"; "stalled" if even the shortest admitted step fails the test of `solve`; or
        "iteration_limit" if the number of steps was reached.
    iterations : int
        Number of steps of Newton's method.
    residual : float
        Largest modulus of an entry of the residual, in the real form of `Balance.to_real`.
    """

    balance: Balance
    coefficients: np.ndarray
    status: str
    iterations: int
    residual: float


def solve(balance, start, iterations=ITERATIONS) -> Solution:
    """Solve the equations of a balance by the damped Newton's method.

    A step is halved until the following step, computed with the same Jacobian, is shorter. This is
    the natural monotonicity test of Deuflhard, Newton Methods for Nonlinear Problems, 2004, section
    3.3. The residual would be a poor measure of progress, because the stiff contact dominates it.
    The method has converged when a step changes no coefficient by more than TOLERANCE times the
    largest coefficient.

    Parameters
    ----------
    balance : Balance
    start : array, shape (1 or 2, any)
        First guess of the coefficients of the lowest retained harmonics. The first guess of all
        higher coefficients is zero.
    iterations : int
        Largest number of steps.

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

    The factors are computed in another thread, because the computation takes seconds with a
    thousand harmonics. In the main thread it would delay the reaction to Ctrl-C.
    """
    pool = ThreadPoolExecutor(1)
    try:
        return pool.submit(lu_factor, matrix, check_finite=False).result()
    finally:
        pool.shutdown(wait=False)


def single_term(oscillator, damper, frequency) -> np.ndarray:
    """Return the coefficients of a single-term solution, the first guess for more harmonics.

    With a damper this is the solution of equation (7) with the smallest |a|; (7) assumes elastic
    contact, so the restitution is not used. Without a damper it is the solution with the largest a
    on the response curve through the peak.

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
        solutions = main_solutions(oscillator, frequency)
        sizes = solutions.amplitude[-1:]
        phase = solutions.phase[-1]
    else:
        solutions = single_harmonic.impacting_solutions(
            oscillator, replace(damper, restitution=1.0), frequency
        )
        if not len(solutions.amplitude):
            raise ArithmeticError(f"frequency = {frequency:g}: (7) has no solution with contacts")
        least = np.argmin(np.abs(solutions.amplitude))
        sizes = np.array([solutions.amplitude[least], solutions.relative_amplitude[least]])
        phase = solutions.phase[least]
    return sizes[:, None] * np.exp(1j * phase) / 2


def refine(balances, start) -> list:
    """Return a `Solution` of each balance.

    The first guess for a balance is the last solution before it that converged.

    Parameters
    ----------
    balances : list of Balance
        In the order of increasing numbers of harmonics.
    start : numpy.ndarray
        First guess for the first balance, for example from `single_term`.
    """
    solutions = []
    for balance in balances:
        solutions.append(solve(balance, start))
        if solutions[-1].status == "converged":
            start = solutions[-1].coefficients
    return solutions


def state_of(solution) -> np.ndarray:
    """Return Z1, Z1', Z2, Z2' of a `Solution` at W T = pi/2, with Z2 = Z1 without a damper."""
    balance = solution.balance
    state = [
        fourier.value(each, balance.harmonics, np.pi / 2, order) * balance.frequency**order
        for each in solution.coefficients
        for order in (0, 1)
    ]
    return np.array(state if len(state) == 4 else 2 * state)
