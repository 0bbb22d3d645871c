"""Verdicts of each method by its tolerance: does a motion stay on an orbit, of which period?

The truth of a scene is exact: whether the orbit exists at the frequency, and its Floquet
multipliers, from Newton's method on the event-driven flow; and where the start leads, from the
same flow at a tolerance of 1e-13. All methods are judged by one rule from strobed states alone.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.motions import records, strobe_map
from impact_damper.rivals import fixed_step, merson, scipy_methods
from impact_damper.system.bounds import check_count, check_number
from impact_damper.system.checks import check_frequency, check_increasing
from impact_damper.system.packed import FREQUENCY
from impact_damper.system.parameters import pack

FIXED = ("heun", "verlet", "runge_kutta_4")
# Through the kink, and with contacts located.
ADAPTIVE = ("merson", "merson_located")
SCIPY = {"LSODA": False, "DOP853_located": True}
METHODS = ("taylor", *FIXED, *ADAPTIVE, *SCIPY)
EXACT = 1e-13
# SciPy's methods may evaluate the rate so often in a forcing period, on average.
EVALUATIONS = 2000
# The rule: a motion has settled if its last states repeat this closely, and it is on an orbit if
# the primary mass is this near to it.
REPEATS, NEAR = 1e-3, 5e-3
LAST, LONGEST_PERIOD = 6, 6


class Scene(NamedTuple):
    """A start near an orbit, and what becomes of it.

    Attributes
    ----------
    parameters : numpy.ndarray, shape (packed.COUNT,)
    orbit, start : numpy.ndarray, shape (4,)
        States at W T = pi/2; the orbit at the frequency where it was found, if it has ended.
    period, periods : int
        Of the orbit; forcing periods to run.
    multiplier : float
        Modulus of the dominant Floquet multiplier, NaN where there is no orbit.
    landing : numpy.ndarray, shape (n, 2)
        Strobed Z1, Z1' of the orbit that the motion settles on, none if it does not settle.
    stays : bool
        Whether that is the orbit.
    scipy_every : int
        SciPy's methods, a hundred times slower, are run at every so many tolerances, or never: 0.
    """

    parameters: np.ndarray
    orbit: np.ndarray
    start: np.ndarray
    period: int
    periods: int
    multiplier: float
    landing: np.ndarray
    stays: bool
    scipy_every: int


def settled_period(states):
    """Smallest period with which the last strobed states repeat, 0 if none does."""
    for n in range(1, LONGEST_PERIOD + 1):
        last = states[-LAST:, :2]
        if np.abs(last - states[-LAST - n : -n, :2]).max() < REPEATS:
            return n
    return 0


def is_on(states, points, period):
    """Whether a motion has settled with a period and passes near one of some points (n, 2)."""
    if settled_period(states) != period:
        return False
    away = np.abs(states[-period:, None, :2] - points).max(axis=2)
    return bool(away.min() < NEAR)


def make_scene(
    oscillator, damper, frequency, *, near, period, offset, periods, orbit_frequency, scipy_every
):
    """A scene with its truth.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        W.
    near : sequence of float
        A state near the orbit at W T = pi/2.
    period : int
    offset : sequence of float
        Start less the orbit's state.
    periods : int
        Forcing periods to run.
    orbit_frequency : float
        Where the orbit of reference is found; it may have ended at the scene's frequency.
    scipy_every : int
        As in `Scene`.

    Raises
    ------
    ValueError
        If there is no such orbit, or the rule cannot tell in so many periods.
    """
    check_count("scipy_every", scipy_every, least=0)
    check_count("periods", periods, least=LAST + LONGEST_PERIOD, most=10**6)
    orbit = np.array(near, float)
    there = pack(oscillator, damper, check_frequency(orbit_frequency))
    if not strobe_map.polish(there, orbit, period, 0.05, EXACT)[0]:
        raise ValueError(f"near = {near}: there is no orbit of period {period} at it")
    p = pack(oscillator, damper, frequency)
    here = orbit.copy()
    found, _, multiplier = strobe_map.polish(p, here, period, 0.05, EXACT)
    if found:
        orbit = here
    start = orbit + np.array(offset, float)
    exact = _taylor(p, start, periods, EXACT)
    stays = is_on(exact, orbit[None, :2], period)
    landed = settled_period(exact)
    landing = exact[len(exact) - landed :, :2].copy()
    modulus = abs(multiplier) if found else np.nan
    if stays and not modulus < 1.0:
        raise ValueError(
            f"periods = {periods}: at W = {frequency:g} the motion must leave the orbit, whose "
            f"multiplier is {modulus:g}, and has not done so by the rule: more periods are needed"
        )
    return Scene(p, orbit, start, period, periods, modulus, landing, stays, scipy_every)


def _taylor(p, start, periods, tolerance):
    """Strobed states by the event-driven Taylor series."""
    begin = strobe_map.strobe_time(p)
    times = begin + 2 * np.pi / p[FREQUENCY] * np.arange(1, periods + 1)
    states = np.empty((periods, 4))
    records.trace(p, start.copy(), begin, times, tolerance, states, np.empty((0, 5)))
    return states


def _strobes(method, scene, resolution):
    """Strobed states by a method, NaN from a failure on."""
    p, start = scene.parameters, scene.start
    begin = strobe_map.strobe_time(p)
    if method == "taylor":
        return _taylor(p, start, scene.periods, resolution)
    if method in SCIPY:
        name = method.removesuffix("_located")
        return scipy_methods.run_scipy(
            name,
            p,
            start,
            begin,
            resolution,
            SCIPY[method],
            scene.periods,
            EVALUATIONS * scene.periods,
        )
    strobes, largest = np.empty((scene.periods, 4)), np.empty(scene.periods)
    if method in FIXED:
        number = fixed_step.METHODS.index(method)
        fixed_step.run_fixed(number, p, start, begin, resolution, strobes, largest)
    else:
        located = method == "merson_located"
        merson.run_merson(p, start, begin, resolution, located, strobes, largest)
    return strobes


def judge(states, scene):
    """What the rule makes of strobed states, against the truth of the scene."""
    if not np.isfinite(states).all():
        return "failed"
    found, landed = settled_period(states), len(scene.landing)
    if landed > 0 and is_on(states, scene.landing, landed):
        return "right"
    if is_on(states, scene.orbit[None, :2], scene.period):
        return "stays_wrongly"
    if landed == 0:
        return "right"
    if found == 0:
        return "not_settled"
    return "wrong_branch" if found == landed else "wrong_period"


def right_from(right):
    """Index from which on a row of verdicts is right to its end, its length if it ends wrong."""
    wrong = np.flatnonzero(~right)
    return wrong[-1] + 1 if len(wrong) else 0


def verdicts(scenes, tolerances, steps):
    """The verdict of each method on each scene, by tolerance or steps a forcing period.

    Parameters
    ----------
    scenes : dict of Scene
        By name.
    tolerances : sequence of float
        Increasing.
    steps : sequence of int
        Increasing, as many: steps a forcing period of the fixed-step methods, the fewest in the
        place of the largest tolerance.

    Returns
    -------
    xarray.Dataset
        `verdict` over (scene, verdict_method, method_tolerance), and over (scene, verdict_method)
        `right_from`: the largest tolerance, or number of steps, from which on all are right; NaN
        where the last is not.

    Raises
    ------
    TypeError, ValueError
        If an argument is not of its kind or out of range.
    """
    tolerances = check_increasing(
        "tolerances", [check_number("tolerance", value, least=1e-14) for value in tolerances]
    )
    steps = [check_count("steps", value, most=10**7) for value in steps]
    check_increasing("steps", steps)
    if len(steps) != len(tolerances):
        raise ValueError(f"steps: must be as many as tolerances, {len(tolerances)}; {steps} given")
    steps = np.array(steps[::-1])
    shape = (len(scenes), len(METHODS), len(tolerances))
    found = np.full(shape, flag("verdict", "not_run"))
    resolution = np.full(shape[:2], np.nan)
    for i, scene in enumerate(scenes.values()):
        for m, method in enumerate(METHODS):
            resolutions = [int(n) for n in steps] if method in FIXED else tolerances
            every = scene.scipy_every if method in SCIPY else 1
            if every == 0:
                continue
            run = np.arange(0, len(tolerances), every)
            for j in run:
                name = judge(_strobes(method, scene, resolutions[j]), scene)
                found[i, m, j] = flag("verdict", name)
            loosest_first = run[::-1]
            k = right_from(found[i, m, loosest_first] == flag("verdict", "right"))
            if k < len(run):
                resolution[i, m] = resolutions[loosest_first[k]]
    data = {
        "verdict": found,
        "right_from": resolution,
        "verdict_steps": steps,
        "scene_multiplier": np.array([scene.multiplier for scene in scenes.values()]),
        "scene_period": np.array([scene.period for scene in scenes.values()]),
        "scene_periods": np.array([scene.periods for scene in scenes.values()]),
        "scene_frequency": np.array([scene.parameters[FREQUENCY] for scene in scenes.values()]),
        "landing_period": np.array([len(scene.landing) for scene in scenes.values()]),
        "scene_truth": np.array(
            [flag("scene_truth", "stays" if each.stays else "leaves") for each in scenes.values()]
        ),
    }
    coordinates = {
        "scene": list(scenes),
        "verdict_method": list(METHODS),
        "method_tolerance": tolerances,
    }
    return dataset(data, coordinates, {}, "Verdicts of each method by tolerance")
