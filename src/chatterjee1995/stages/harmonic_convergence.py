"""Harmonic balance with a rising number of harmonics (`docs/explanation/convergence.md`)."""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import linear_sum_assignment

from chatterjee1995.methods import fourier, hill
from chatterjee1995.methods.many_harmonics import Balance, refine, single_term, solve, state_of
from impact_damper.data.datasets import dataset, flag
from impact_damper.data.variables import register
from impact_damper.kernel.equation import forcing_amplitude
from impact_damper.model.exit_rules import damping_ratio
from impact_damper.model.packed import DAMPING, FREQUENCY, cubic_spring, pack
from impact_damper.model.parameters import describe
from impact_damper.motions.simulate import simulate
from impact_damper.orbits.shooting import find_orbit

register(
    """
highest_harmonic | highest_harmonic | | N | highest harmonic
error_measure | error_measure | | | quantity whose error is listed
series_status | highest_harmonic | | | how Newton's method ended when started from the solution
  with fewer harmonics
  : converged 0, stalled 1, iteration_limit 2
series_error | error_measure highest_harmonic | | | difference from the exact orbit: of max |Z1|,
  and of Z1 in the harmonics up to N and beyond N (root mean square), divided by max |Z1|; and of
  a Floquet multiplier
cold_status | highest_harmonic | | | how Newton's method ended when started from the single-term
  solution
  : not_tried -1, same_motion 0, stalled 1, iteration_limit 2, another_motion 3
hill_status | highest_harmonic | | | how Hill's method ended
  : not_tried -1, found 0, not_separated 1, not_converged 2
exact_maximum | | displacement | max |Z1| | largest displacement of the exact orbit, or NaN
asymptotic_harmonic | | | | lowest N whose errors are used in the fit of the decrease
decay_kind | | | | decrease of the errors: a power of N, or exponential
  : algebraic 0, exponential 1
decay_observed | error_measure | | | fitted power of 1/N, or rate per harmonic, at which an error
  decreases
decay_predicted | error_measure | | | predicted power of 1/N, or rate per harmonic
    """
)

# MEASURES: four errors of a balance with the highest harmonic N. "maximum": error of max |Z1|.
# "retained": error of Z1 in the harmonics up to N. "omitted": size of Z1 in the harmonics beyond N.
# "multiplier": largest error of a Floquet multiplier. Each error should decrease as N^-n, with n
# from ELASTIC if e = 1 and from INELASTIC if e < 1. Without a damper it should decrease as
# exp(-n W D N), with n from ANALYTIC. D is `singularity_distance`.
MEASURES = ("maximum", "retained", "omitted", "multiplier")
ELASTIC = (4.0, 5.0, 3.5, 4.0)
INELASTIC = (3.0, 3.0, 2.5, 3.0)
ANALYTIC = (1.0, 1.0, 1.0, 2.0)
# Constants of `singularity_distance`. The unit of |Z1| is x = (f/|k3|)^(1/3), with the forcing
# amplitude f. The unit of time is 1/(x sqrt|k3|).
# STARTS: number of start times in half a forcing cycle.
# LARGE: |Z1| at which an integration towards the singularity stops.
# LAST_CHANGE: the search ends if the last two integrations stop at times that differ by less.
# CLOSE: all integrations but the first go this fraction of the way to the singularity.
STARTS, LARGE, LAST_CHANGE, CLOSE = 12, 30.0, 1e-6, 0.95


def asymptotic_harmonic(damper, frequency) -> float:
    """Return the harmonic above which errors can decrease as predicted; 1 without a damper.

    Harmonics above the result have periods shorter than a contact (appendix B). If the walls have a
    dashpot with the coefficient c, the result is at least r1/(c W). In harmonics above r1/(c W) the
    jump c Z2' of the contact force outweighs the jump r1 Z2' of its slope.
    """
    if damper is None:
        return 1.0
    ratio = damping_ratio(damper.restitution)
    resolving = 2 * damper.contact_frequency * np.sqrt(1 - ratio**2) / frequency
    if damper.restitution == 1:
        return float(resolving)
    return float(max(resolving, damper.contact_stiffness / (damper.dashpot * frequency)))


def decay(damper, p, state) -> tuple:
    """Return how errors should decay: "algebraic" and exponents, or "exponential" and rates."""
    if damper is None:
        return "exponential", np.array(ANALYTIC) * p[FREQUENCY] * singularity_distance(p, state)
    return "algebraic", np.array(ELASTIC if damper.restitution == 1 else INELASTIC)


def singularity_distance(p, state) -> float:
    """Return the smallest positive imaginary part of T at which a free motion is singular.

    The result is infinite if k3 = 0. Near a singularity T*, Z1 = sqrt(-2/k3)/(T - T*). Therefore
    T + Z1/Z1' estimates T*. Integration in complex time towards T* improves the estimate.
    """
    frequency, (stiffness, cubic) = p[FREQUENCY], cubic_spring(p)
    if cubic == 0:
        return np.inf
    force = forcing_amplitude.py_func(p)
    length = (force / abs(cubic)) ** (1 / 3)
    duration = 1 / (np.sqrt(abs(cubic)) * length)

    def rates(time, y):
        x, v = y
        drive = force * np.cos(frequency * time)
        return np.array([v, drive - p[DAMPING] * v - stiffness * x - cubic * x**3])

    def integrate(y, begin, end):

        def large(fraction, y):
            return LARGE * length - abs(y[0])

        large.terminal = True
        run = solve_ivp(
            lambda fraction, y: (end - begin) * rates(begin + fraction * (end - begin), y),
            (0, 1),
            y.astype(complex),
            method="DOP853",
            events=large,
            rtol=1e-10,
            atol=1e-12 * length,
        )
        return begin + run.t[-1] * (end - begin), run.y[:, -1]

    begin = 0.5 * np.pi / frequency
    heights = []
    for lag in np.pi / frequency * np.arange(STARTS) / STARTS:
        _, real = integrate(state[:2], begin, begin + lag)
        time, y = integrate(real, begin + lag, begin + lag + 1j * np.pi / frequency)
        for _ in range(8):
            before, singularity = time, time + y[0] / y[1]
            if not 0 < singularity.imag < 2 * np.pi / frequency:
                break
            _, real = integrate(state[:2], begin, singularity.real)
            close = complex(singularity.real, CLOSE * singularity.imag)
            time, y = integrate(real, complex(singularity.real), close)
            if abs(time - before) < LAST_CHANGE * duration:
                heights.append(singularity.imag)
                break
    return float(min(heights, default=np.nan))


SAMPLES = 2**14  # number of values of Z1 in a cycle, for Fourier coefficients of the exact orbit
SAME = 1e-6  # largest difference of coefficients of equal solutions, over the largest coefficient
ROUNDING = 1e-12  # errors below this value are left out of the fit of the decrease
FINEST = 1e-14  # tolerance with which the exact orbit is integrated


def ladder(highest) -> np.ndarray:
    """Return odd numbers up to `highest` (at most 2^14): all up to 15, then in steps of 26 %."""
    powers = np.round(2.0 ** np.arange(4, 14.01, 1 / 3))
    chosen = np.concatenate([np.arange(1, 16, 2), 2 * (powers // 2).astype(int) - 1])
    return np.unique(chosen[chosen <= highest])


def harmonic_convergence(oscillator, damper, frequency, harmonics, *, cold=()):
    """Return a dataset of errors of harmonic balance against a symmetric exact orbit.

    Each of `harmonics` is the highest harmonic of a balance. Newton's method starts from the
    solution of the last balance that converged. For each highest harmonic in `cold`, it starts a
    second time, from the solution with one harmonic.
    """
    harmonics = np.asarray(harmonics, int)
    balances = [Balance(oscillator, damper, frequency, int(highest)) for highest in harmonics]
    first = single_term(oscillator, damper, frequency)
    solutions = refine(balances, first)
    best = [each for each in solutions if each.status == "converged"]
    state = state_of(best[-1]) if best else np.zeros(4)
    p = pack(oscillator, damper, frequency)
    exact = find_orbit(p, state)
    data = {
        "series_status": [flag("series_status", each.status) for each in solutions],
        "cold_status": [
            cold_status(each, first) if each.balance.highest in cold else -1 for each in solutions
        ],
    }
    number = 2 if damper is None else 4
    found = exact.converged and exact.active == number
    data["exact_maximum"] = exact.record["maximum_displacement"] if found else np.nan
    exponents = [hill.exponents(each) if each.status == "converged" else None for each in solutions]
    status = [each.status if each else "not_tried" for each in exponents]
    data["hill_status"] = [flag("hill_status", each) for each in status]
    period = 2 * np.pi / frequency
    multipliers = [
        each.multipliers(period) if each else np.full(number, np.nan) for each in exponents
    ]
    data["series_error"] = np.full((len(MEASURES), len(solutions)), np.nan)
    if found:
        data["series_error"] = errors(solutions, multipliers, exact)
    data |= decay_table(harmonics, data, damper, p, exact)
    made = describe(oscillator, damper) | {"frequency": float(frequency)}
    coordinates = {"highest_harmonic": harmonics, "error_measure": list(MEASURES)}
    title = "Harmonic balance with many harmonics against the exact orbit"
    return dataset(data, coordinates, made, title)


def cold_status(warm, first) -> int:
    """Compare the solution `warm` with a solution that begins at the coefficients `first`."""
    found = solve(warm.balance, first)
    if found.status != "converged":
        return flag("cold_status", found.status)
    away = np.max(np.abs(found.coefficients - warm.coefficients))
    same = warm.status == "converged" and away <= SAME * np.max(np.abs(found.coefficients))
    return flag("cold_status", "same_motion" if same else "another_motion")


def errors(solutions, multipliers, exact):
    """Return the errors of solutions against the exact orbit, a row for each of MEASURES."""
    found = np.full((len(MEASURES), len(solutions)), np.nan)
    balance, size = solutions[0].balance, exact.record["maximum_displacement"]
    start = exact.strobe_states[0]
    orbit = simulate(
        *(balance.oscillator, balance.damper, balance.frequency),
        start if balance.damper is not None else start[:2],
        **{"periods": 1, "samples": SAMPLES, "tolerance": FINEST},
        start=np.pi / (2 * balance.frequency),
    )
    # The samples begin at W T = pi/2. `np.roll` shifts their beginning to W T = 0.
    coefficients = np.fft.rfft(np.roll(orbit["displacement"].values[:-1], SAMPLES // 4)) / SAMPLES
    for k, solution in enumerate(solutions):
        if solution.status == "converged":
            away = coefficients.copy()
            away[solution.balance.harmonics] -= solution.coefficients[0]
            first_omitted = solution.balance.highest + 1
            largest = fourier.largest(solution.coefficients[0], solution.balance.harmonics)
            found[0, k] = abs(largest - size) / size
            found[1, k] = np.sqrt(2 * np.sum(np.abs(away[:first_omitted]) ** 2)) / size
            found[2, k] = np.sqrt(2 * np.sum(np.abs(away[first_omitted:]) ** 2)) / size
            found[3, k] = _farthest(multipliers[k], exact.multipliers[: exact.active])
    return found


def _farthest(values, references):
    if np.isnan(values).any():
        return np.nan
    away = np.abs(values[:, None] - references)
    return np.max(away[linear_sum_assignment(away)])


def decay_table(harmonics, data, damper, p, exact):
    """Return the predicted and the fitted decay of `data["series_error"]` over `harmonics`."""
    lowest = asymptotic_harmonic(damper, p[FREQUENCY])
    kind, predicted = decay(damper, p, exact.strobe_states[0])
    scale = np.log(harmonics) if kind == "algebraic" else harmonics
    observed = np.full(len(MEASURES), np.nan)
    for k, error in enumerate(data["series_error"]):
        used = (harmonics >= lowest) & (error > ROUNDING)
        if np.sum(used) > 2:
            observed[k] = -np.polyfit(scale[used], np.log(error[used]), 1)[0]
    return {
        "asymptotic_harmonic": lowest,
        "decay_kind": flag("decay_kind", kind),
        "decay_observed": ("error_measure", observed),
        "decay_predicted": ("error_measure", predicted),
    }
