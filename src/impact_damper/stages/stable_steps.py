"""The largest steps with which fixed-step methods keep the quiet motion, against the stiffness r1.

Every run starts on the exact quiet orbit and goes through the kinks with equal steps, a whole
number of them in a forcing period. The linear stability of a method bounds h omega_c, where
omega_c = sqrt(r1 (1 + 1/rm)) is the natural frequency of an undamped contact.
"""

import math
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.motions import ensemble, records, strobe_map
from impact_damper.motions.ensemble import Settling
from impact_damper.rivals.fixed_step import METHODS, STABILITY_LIMIT, run_fixed
from impact_damper.system.bounds import check_count, check_number
from impact_damper.system.checks import check_increasing
from impact_damper.system.packed import CLEARANCE, FREQUENCY
from impact_damper.system.parameters import check_damper, describe, pack
from impact_damper.theory.free_oscillator import free_solutions

ACCURACIES = (0.01, 0.1)
# Following in r1: steps by this factor, and how far an orbit may move in one.
FACTOR = 10.0**0.0625
REACH = 0.2
# Steps tested must hold this often in a row, down to the smallest, for the largest to count.
CONFIRMED = 4
# The slope in r1 is fitted where contacts are short against the forcing period.
STIFF = 1e3


class Orbit(NamedTuple):
    """The quiet orbit at one stiffness: parameters, its state at W T = pi/2, and what it is.

    Attributes
    ----------
    parameters : numpy.ndarray, shape (packed.COUNT,)
    state : numpy.ndarray, shape (4,)
    displacement : float
        max |Z1|.
    multiplier : float
        Modulus of the dominant Floquet multiplier.
    """

    parameters: np.ndarray
    state: np.ndarray
    displacement: float
    multiplier: float


def quiet_state(p):
    """State at W T = pi/2 of the quiet motion, or None if the motion from near it is another.

    It is settled from rest with the loose mass in straight flight from wall to wall.
    """
    start = np.array([[0.0, 0.0, 0.0, -2 * p[CLEARANCE] * p[FREQUENCY] / math.pi]])
    record = ensemble.settle(p[None], start, Settling(), from_strobe=True)[0]
    if is_settled(record) and record["period"] == 1 and record["contacts"] == 2:
        return record["state"].copy()
    return None


def _polished(p, y):
    """The orbit next to a state, or None."""
    state = y.copy()
    found, _, multiplier = strobe_map.polish(p, state, 1, REACH, 1e-13)
    if not found:
        return None
    size = records.measured(p, state, 1, 1e-13)["maximum_displacement"]
    return Orbit(p, state, size, abs(multiplier))


def quiet_orbits(oscillator, damper, frequency, stiffnesses) -> list:
    """The quiet orbit at each stiffness r1, followed from that of the damper, or None."""
    start = quiet_state(pack(oscillator, damper, frequency))
    if start is None:
        raise ArithmeticError(
            f"damper = {damper!r}: has no quiet motion at frequency = {frequency:g}, from which "
            "the stiffness is varied"
        )
    found = [None] * len(stiffnesses)
    upward = [i for i, value in enumerate(stiffnesses) if value >= damper.contact_stiffness]
    downward = [i for i in reversed(range(len(stiffnesses))) if i not in upward]
    for chain in (upward, downward):
        here, y = damper.contact_stiffness, start
        for i in chain:
            count = math.ceil(abs(math.log(stiffnesses[i] / here)) / math.log(FACTOR))
            for value in np.geomspace(here, stiffnesses[i], count + 1)[-max(count, 1) :]:
                p = pack(oscillator, replace(damper, contact_stiffness=float(value)), frequency)
                found[i] = _polished(p, y)
                if found[i] is None:
                    break
                y = found[i].state
            if found[i] is None:
                break
            here = stiffnesses[i]
    return found


def _verdict(largest, exact, bound):
    """Deviation of the largest |Z1| of any period from the exact one, and what it amounts to."""
    if not np.isfinite(largest).all():
        return np.inf, "diverged"
    deviation = np.abs(largest / exact - 1).max()
    if largest.max() > bound:
        return deviation, "escaped"
    for accuracy, name in zip(ACCURACIES, ("within_1_percent", "within_10_percent"), strict=True):
        if deviation <= accuracy:
            return deviation, name
    return deviation, "off"


def _largest_step(held, tested, steps):
    """The largest step from which on all smaller ones hold, NaN unless CONFIRMED of them do."""
    held, steps = held[tested], steps[tested]
    failing = np.flatnonzero(~held)
    first = failing[-1] + 1 if len(failing) else 0
    return steps[first] if first + CONFIRMED <= len(steps) else np.nan


def _slope(stiffnesses, steps):
    """Slope of log(1/step) over log r1 and its standard error, NaN with fewer than three points."""
    use = np.isfinite(steps) & (stiffnesses >= STIFF)
    if use.sum() < 3:
        return np.nan, np.nan
    x, y = np.log(stiffnesses[use]), -np.log(steps[use])
    (slope, offset), rest = np.polyfit(x, y, 1), x - x.mean()
    variance = np.sum((y - slope * x - offset) ** 2) / (use.sum() - 2)
    return slope, math.sqrt(variance / np.sum(rest**2))


def stable_steps(oscillator, damper, frequency, *, stiffnesses, scaled_steps, most_steps, periods):
    """How fixed-step methods keep the quiet motion, over stiffness and step.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
        From whose quiet motion the exact orbits at other stiffnesses are followed.
    frequency : float
        W.
    stiffnesses : sequence of float
        Increasing values of r1.
    scaled_steps : sequence of float
        Increasing values of h omega_c; the number of steps in a forcing period is rounded up.
    most_steps : int
        Most steps a forcing period: cells that would take more are not run.
    periods : int
        Forcing periods of a run.

    Returns
    -------
    xarray.Dataset
        Over (fixed_method, contact_stiffness, scaled_step) the `step_verdict`, and the
        `step_deviation`, the largest relative deviation in any period of max |Z1| from the exact
        one, NaN where none was run. A run has escaped if |Z1| exceeds half the largest free
        amplitude of harmonic balance at W. `stable_step` over (fixed_method, contact_stiffness,
        accuracy): h of the largest step from which on all smaller ones hold, if these are
        CONFIRMED or more; `largest_holding_step`: of the largest that holds at all, with others
        below it that do not. `step_slope` and its error: of log(1/h) over log r1 from r1 = 1000
        on.

    Raises
    ------
    ArithmeticError
        If there is no quiet motion.
    TypeError, ValueError
        If an argument is not of its kind or out of range.
    """
    check_damper(damper)
    check_count("periods", periods, most=10**6)
    check_count("most_steps", most_steps, most=10**8)
    stiffnesses = check_increasing(
        "stiffnesses", [check_number("stiffness", r1, above=0.0, most=1e9) for r1 in stiffnesses]
    )
    scaled = check_increasing(
        "scaled_steps", [check_number("scaled_step", h, above=0.0) for h in scaled_steps]
    )
    scaled = scaled[::-1]
    bound = 0.5 * np.max(np.abs(free_solutions(oscillator, frequency).amplitude))
    found = quiet_orbits(oscillator, damper, frequency, stiffnesses)
    shape = (len(METHODS), len(stiffnesses), len(scaled))
    verdicts = np.full(shape, flag("step_verdict", "not_run"))
    deviations = np.full(shape, np.nan)
    contact = np.sqrt(stiffnesses * (1 + 1 / damper.mass_ratio))
    period = 2 * math.pi / frequency
    counts = np.ceil(period * contact[:, None] / scaled).astype(int)
    strobes, largest = np.empty((periods, 4)), np.empty(periods)
    for i, orbit in enumerate(found):
        if orbit is None:
            verdicts[:, i] = flag("step_verdict", "no_orbit")
            continue
        begin = strobe_map.strobe_time(orbit.parameters)
        for m in range(len(METHODS)):
            for j, steps in enumerate(counts[i]):
                if steps > most_steps:
                    continue
                run_fixed(m, orbit.parameters, orbit.state, begin, steps, strobes, largest)
                deviations[m, i, j], name = _verdict(largest, orbit.displacement, bound)
                verdicts[m, i, j] = flag("step_verdict", name)
    sizes, tested = period / counts, counts <= most_steps
    held = np.stack([deviations <= accuracy for accuracy in ACCURACIES], axis=-1)
    stable = np.array(
        [
            [
                [_largest_step(each, tested[i], sizes[i]) for each in held[m, i].T]
                for i in range(len(stiffnesses))
            ]
            for m in range(len(METHODS))
        ]
    )
    holding = np.where(held, sizes[:, :, None], -np.inf).max(axis=2)
    slopes = np.array([[_slope(stiffnesses, row) for row in each.T] for each in stable])
    limits = np.array([STABILITY_LIMIT[name] for name in METHODS])
    data = {
        "step_verdict": verdicts,
        "step_deviation": deviations,
        "steps_per_period": counts,
        "stable_step": stable,
        "largest_holding_step": np.where(np.isfinite(holding), holding, np.nan),
        "step_slope": slopes[..., 0],
        "step_slope_error": slopes[..., 1],
        "linear_limit": limits,
        "contact_frequency": contact,
        "reference_displacement": _of(found, "displacement"),
        "orbit_multiplier": _of(found, "multiplier"),
        "free_bound": bound,
    }
    made = describe(oscillator, damper) | {"frequency": frequency, "periods": periods}
    coordinates = {
        "fixed_method": list(METHODS),
        "contact_stiffness": stiffnesses,
        "scaled_step": scaled,
        "accuracy": list(ACCURACIES),
    }
    return dataset(data, coordinates, made, "Largest steps that keep the quiet motion")


def _of(found, name):
    """An attribute of each orbit, NaN where there is none."""
    return np.array([np.nan if orbit is None else getattr(orbit, name) for orbit in found])
