"""Harmonic balance with a rising number of harmonics, compared with the exact periodic orbit.

A balance is the system of equations for the coefficients of the harmonics 1, 3, ... N. An exact
orbit is a periodic motion found by Newton's method with an accurate integrator. Equation (7) of the
paper is the balance with one harmonic, of amplitude |a|; e is the restitution. Floquet multipliers
say whether a motion is stable.

Z1 is the displacement of the primary mass, W T the phase of the forcing and rm the mass ratio.
"""

import numpy as np
from scipy.optimize import linear_sum_assignment

from chatterjee1995.stages import convergence
from impact_damper.data.datasets import dataset, flag
from impact_damper.model.bounds import HARMONIC_RANGE, check_count, shown
from impact_damper.model.checks import check_counts, check_increasing
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.motions.simulate import simulate
from impact_damper.orbits.shooting import find_orbit
from impact_damper.theory import fourier, hill
from impact_damper.theory.many_harmonics import Balance, refine, single_term, solve, state_of

# Number of values of Z1 in a cycle of the exact orbit for its Fourier coefficients.
SAMPLES = 2**14
# Two solutions are the same if their coefficients differ relatively by less than SAME.
SAME = 1e-6
# Errors below this value are due to rounding; fits of the decrease leave them out.
ROUNDING = 1e-12
# Tolerance with which the exact orbit is integrated.
FINEST = 1e-14


def ladder(highest) -> np.ndarray:
    """Return odd numbers N up to `highest`: all up to 15, then three for each doubling."""
    check_count("highest", highest, **HARMONIC_RANGE)
    powers = np.round(2.0 ** np.arange(4, 14.01, 1 / 3))
    chosen = np.concatenate([np.arange(1, 16, 2), 2 * (powers // 2).astype(int) - 1])
    return np.unique(chosen[chosen <= highest])


def harmonic_convergence(oscillator, damper, frequency, harmonics, *, cold=()):
    """Return symmetric motions by harmonic balance, with their stability and errors.

    The stability follows from Floquet multipliers, which Hill's method computes from the Fourier
    series of the linearised motion (`theory.hill`).

    For the first balance Newton's method starts from a single-term solution: the solution of (7)
    for e = 1 with the smallest |a|, or without a damper the free solution with the largest |a|. For
    each further balance it starts from the last balance that converged. For the exact orbit it
    starts from the balance with most harmonics.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        Forcing frequency W, dimensionless.
    harmonics : sequence of int
        Increasing odd numbers N, each the highest of the harmonics 1, 3, ... N.
    cold : sequence of int
        Values in `harmonics` for which Newton's method is also started directly from the
        single-term solution (cold start).

    Returns
    -------
    xarray.Dataset
        For each `highest_harmonic` N: status, steps and residual of Newton's method, largest
        displacement, errors relative to the exact orbit (NaN if it was not found), Floquet
        multipliers by Hill's method, and the result of the cold start. For each error the observed
        and predicted rates at which it decreases as N grows (`theory.convergence`).

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    ArithmeticError
        If there is no single-term solution to begin from.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> found = harmonic_convergence(oscillator, damper, 2.0, [1, 3, 5])
    >>> float(found.series_maximum[0].round(5))
    0.00819
    """
    harmonics = check_counts("harmonics", harmonics, **HARMONIC_RANGE)
    check_increasing("harmonics", harmonics)
    if np.any(harmonics % 2 == 0):
        given = shown(harmonics.tolist())
        raise ValueError(f"harmonics = {given}: must be odd (the motion is symmetric)")
    if not set(check_counts("cold", cold)) <= set(harmonics):
        given = shown(harmonics.tolist())
        raise ValueError(f"cold = {shown(cold)}: must be among the harmonics {given}")
    balances = [Balance(oscillator, damper, frequency, int(highest)) for highest in harmonics]
    first = single_term(oscillator, damper, frequency)
    solutions = refine(balances, first)
    best = [each for each in solutions if each.status == "converged"]
    state = state_of(best[-1]) if best else np.zeros(4)
    p = pack(oscillator, damper, frequency)
    exact = find_orbit(p, state)
    data = {
        "series_status": [flag("series_status", each.status) for each in solutions],
        "series_steps": [each.iterations for each in solutions],
        "series_residual": [each.residual for each in solutions],
        "series_maximum": [
            fourier.largest(each.coefficients[0], each.balance.harmonics)
            if each.status == "converged"
            else np.nan
            for each in solutions
        ],
        "cold_status": [
            cold_status(each, first) if each.balance.highest in cold else -1 for each in solutions
        ],
    }
    data |= hill_table(solutions, exact)
    data |= exact_table(exact, 2 if damper is None else 4)
    data["series_error"] = errors(data, solutions, exact)
    data |= decay_table(harmonics, data, damper, p, exact)
    made = describe(oscillator, damper) | {"frequency": float(frequency)}
    return dataset(
        data,
        {"highest_harmonic": harmonics, "error_measure": list(convergence.MEASURES)},
        made,
        "Harmonic balance with many harmonics against the exact orbit",
    )


def cold_status(warm, first) -> int:
    """Solve a balance from the single-term solution; return the result as a flag `cold_status`.

    `warm` is the solution of the same balance found from the balance with fewer harmonics.
    """
    found = solve(warm.balance, first)
    if found.status != "converged":
        return flag("cold_status", found.status)
    away = np.max(np.abs(found.coefficients - warm.coefficients))
    same = warm.status == "converged" and away <= SAME * np.max(np.abs(found.coefficients))
    return flag("cold_status", "same_motion" if same else "another_motion")


def hill_table(solutions, exact):
    """Return the variables of Floquet multipliers by Hill's method, a dict.

    `solutions` are the solutions of the balances, and `exact` is the exact `Orbit`.
    """
    oscillator, damper, frequency = (
        getattr(solutions[0].balance, name) for name in ("oscillator", "damper", "frequency")
    )
    period = 2 * np.pi / frequency
    trace = -oscillator.damping
    if damper is not None:
        # Sum of the Floquet exponents (Liouville's theorem): the average over a cycle of -h and,
        # during contact, also of -c (1 + 1/rm), with the damping h and the dashpot c of the wall.
        trace -= damper.dashpot * (1 + 1 / damper.mass_ratio) * exact.touching / period
    multipliers = np.full((len(solutions), 2 if damper is None else 4), complex(np.nan, np.nan))
    status = np.full(len(solutions), flag("hill_status", "not_tried"))
    traces = np.full(len(solutions), np.nan)
    for k, solution in enumerate(solutions):
        if solution.status == "converged":
            found = hill.exponents(solution)
            status[k] = flag("hill_status", found.status)
            multipliers[k] = found.multipliers(period)
            traces[k] = np.sum(found.values.real)
    return {
        "hill_status": status,
        "hill_multiplier_real": multipliers.real,
        "hill_multiplier_imaginary": multipliers.imag,
        "hill_trace_error": np.abs(traces - trace)
        if exact.converged
        else np.full_like(traces, np.nan),
    }


def exact_table(exact, number):
    """Return the variables of the exact orbit, with `number` Floquet multipliers."""
    found = exact.converged and exact.active == number
    multipliers = exact.multipliers[:number] if found else np.full(number, complex(np.nan, np.nan))
    maximum = exact.record["maximum_displacement"]
    return {
        "exact_status": flag("exact_status", "found" if found else "not_found"),
        "exact_residual": exact.residual,
        "exact_maximum": maximum if found else np.nan,
        "exact_multiplier_real": multipliers.real,
        "exact_multiplier_imaginary": multipliers.imag,
    }


def errors(data, solutions, exact):
    """Return errors relative to the exact orbit, shape (4, n): a row per `convergence.MEASURES`."""
    found = np.full((4, len(solutions)), np.nan)
    if data["exact_status"] == flag("exact_status", "not_found"):
        return found
    balance, size = solutions[0].balance, data["exact_maximum"]
    start = exact.strobe_states[0]
    orbit = simulate(
        balance.oscillator,
        balance.damper,
        balance.frequency,
        start if balance.damper is not None else start[:2],
        periods=1,
        samples=SAMPLES,
        start=np.pi / (2 * balance.frequency),
        tolerance=FINEST,
    )
    # The samples begin at W T = pi/2, a quarter of a forcing cycle after T = 0, so they are shifted
    # by a quarter.
    coefficients = np.fft.rfft(np.roll(orbit["displacement"].values[:-1], SAMPLES // 4)) / SAMPLES
    for k, solution in enumerate(solutions):
        if solution.status == "converged":
            away = coefficients.copy()
            away[solution.balance.harmonics] -= solution.coefficients[0]
            first_omitted = solution.balance.highest + 1
            found[0, k] = abs(data["series_maximum"][k] - size) / size
            found[1, k] = np.sqrt(2 * np.sum(np.abs(away[:first_omitted]) ** 2)) / size
            found[2, k] = np.sqrt(2 * np.sum(np.abs(away[first_omitted:]) ** 2)) / size
            multipliers = (
                data["hill_multiplier_real"][k] + 1j * data["hill_multiplier_imaginary"][k]
            )
            found[3, k] = _farthest(multipliers, exact.multipliers[: exact.active])
    return found


def _farthest(values, references):
    """Return the largest distance between a value and its reference.

    Values and references are paired such that the sum of distances is smallest.
    """
    if np.isnan(values).any():
        return np.nan
    away = np.abs(values[:, None] - references)
    return np.max(away[linear_sum_assignment(away)])


def decay_table(harmonics, data, damper, p, exact):
    """Return the variables of the rates at which errors decrease with N, observed and predicted.

    The observed rates are fitted from `convergence.asymptotic_harmonic` on.
    """
    measures = len(convergence.MEASURES)
    lowest = convergence.asymptotic_harmonic(damper, p[FREQUENCY])
    kind, predicted = convergence.decay(damper, p, exact.strobe_states[0])
    scale = np.log(harmonics) if kind == "algebraic" else harmonics
    observed, fitted = np.full(measures, np.nan), np.zeros(measures, int)
    for k, error in enumerate(data["series_error"]):
        used = (harmonics >= lowest) & (error > ROUNDING)
        fitted[k] = np.sum(used)
        if fitted[k] > 2:
            observed[k] = -np.polyfit(scale[used], np.log(error[used]), 1)[0]
    return {
        "asymptotic_harmonic": lowest,
        "decay_kind": flag("decay_kind", kind),
        "decay_observed": ("error_measure", observed),
        "decay_fitted": ("error_measure", fitted),
        "decay_predicted": ("error_measure", predicted),
    }
