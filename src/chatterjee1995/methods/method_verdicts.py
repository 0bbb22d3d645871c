"""Verdict on each method at each tolerance: does its motion settle on the right orbit?

A method is an integrator. A test case (scene) is a start, an initial state, near a periodic orbit.
Its truth is the motion to which the start leads, computed by the Taylor series, the integrator of
this package, at a tolerance of 1e-13. Newton's method gives the orbit, if it exists at the
frequency, and its Floquet multipliers. The same rule judges all methods. It uses only strobed
states, the states at the phase W T = pi/2 in each cycle.

Z1 is the displacement of the primary mass.
"""

from typing import NamedTuple

import numpy as np

from chatterjee1995.methods.methods import (
    COMPARED,
    LAST,
    LONGEST_PERIOD,
    METHODS,
    VERDICT_PERIODS_RANGE,
    integrators,
    name_and_mode,
)
from chatterjee1995.methods.runs import check_resolutions
from impact_damper.data.datasets import dataset, flag
from impact_damper.model.bounds import check_count
from impact_damper.model.checks import check_frequency
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.motions import strobe_map

LABELS = COMPARED["method_verdicts"]
# Tolerance with which the truth is computed.
EXACT = 1e-13
# A motion has settled if its last strobed Z1 and Z1' repeat within REPEATS. A settled motion is on
# an orbit if one of its last strobed states differs from one of the orbit by less than NEAR.
REPEATS, NEAR = 1e-3, 5e-3


class VerdictScene(NamedTuple):
    """A start near an orbit, and the motion to which it leads.

    Attributes
    ----------
    parameters : numpy.ndarray, shape (packed.COUNT,)
    orbit, start : numpy.ndarray, shape (4,)
        States at W T = pi/2 of the orbit and of the start. If the orbit does not exist at the
        frequency of the scene, `orbit` is its state at the frequency at which it was found.
    period, periods : int
        Period of the orbit, and length of a run, both in forcing cycles.
    multiplier : float
        Modulus of the dominant Floquet multiplier, NaN if the orbit does not exist.
    landing : numpy.ndarray, shape (n, 2)
        Strobed Z1, Z1' of the orbit of period n on which the motion settles; n is 0 if it does not
        settle.
    stays : bool
        Whether the motion settles on the orbit near which it starts.
    scipy_every : int
        SciPy's methods, a hundred times slower, are run at every `scipy_every`-th tolerance only;
        if 0, at none.
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
    """Return the smallest period with which the last LAST strobed states repeat, or 0."""
    for n in range(1, LONGEST_PERIOD + 1):
        last = states[-LAST:, :2]
        if np.abs(last - states[-LAST - n : -n, :2]).max() < REPEATS:
            return n
    return 0


def is_on(states, points, period):
    """Return whether a motion has settled with `period` and comes near one of `points` (n, 2)."""
    if settled_period(states) != period:
        return False
    away = np.abs(states[-period:, None, :2] - points).max(axis=2)
    return bool(away.min() < NEAR)


def make_scene(
    oscillator, damper, frequency, *, near, period, offset, periods, orbit_frequency, scipy_every
):
    """Return a `VerdictScene`: a start near an orbit, and the motion to which it truly leads.

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
        State of the start minus state of the orbit.
    periods : int
        Forcing cycles of a run.
    orbit_frequency : float
        Frequency W at which the orbit is searched for. The orbit need not exist at `frequency`.
    scipy_every : int
        As in `VerdictScene`.

    Raises
    ------
    ValueError
        If there is no such orbit, or the run is too short to show that the motion leaves the orbit.
    """
    check_count("scipy_every", scipy_every, least=0)
    check_count("periods", periods, **VERDICT_PERIODS_RANGE)
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
    exact = integrators()["taylor"].strobes(p, start, strobe_map.strobe_time(p), periods, EXACT)
    stays = is_on(exact, orbit[None, :2], period)
    landed = settled_period(exact)
    landing = exact[len(exact) - landed :, :2].copy()
    modulus = abs(multiplier) if found else np.nan
    if stays and not modulus < 1.0:
        raise ValueError(
            f"periods = {periods}: must be larger, since at W = {frequency:g} the motion leaves "
            f"the orbit, whose multiplier is {modulus:g}, but is still near it at the end of the "
            "run"
        )
    return VerdictScene(p, orbit, start, period, periods, modulus, landing, stays, scipy_every)


def judge(states, scene):
    """Return the verdict on the strobed states of a method, a meaning of the flag `verdict`."""
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
    """Return the first index from which all entries are True; the length if the last is False."""
    wrong = np.flatnonzero(~right)
    return wrong[-1] + 1 if len(wrong) else 0


def _by_resolution(label, scene, tolerances, steps):
    """Return a method's verdict at each tolerance or number of steps, and `right_from`.

    `right_from` is the entry of the dataset (see `verdicts`).
    """
    name, locate = name_and_mode(label)
    method, integrator = METHODS[name], integrators()[name]
    resolutions = steps if method.fixed else tolerances
    found = np.full(len(resolutions), flag("verdict", "not_run"))
    every = scene.scipy_every if method.slow else 1
    if every == 0:
        return found, np.nan
    run = np.arange(0, len(resolutions), every)
    p, begin = scene.parameters, strobe_map.strobe_time(scene.parameters)
    for j in run:
        given = p, scene.start, begin, scene.periods, resolutions[j], locate
        found[j] = flag("verdict", judge(integrator.strobes(*given), scene))
    loosest_first = run[::-1]
    k = right_from(found[loosest_first] == flag("verdict", "right"))
    return found, resolutions[loosest_first[k]] if k < len(run) else np.nan


def verdicts(scenes, tolerances, steps):
    """Judge each method on each scene, at each tolerance or number of steps per forcing cycle.

    Parameters
    ----------
    scenes : dict of VerdictScene
        Keyed by name.
    tolerances : sequence of float
        Increasing.
    steps : sequence of int
        Increasing numbers of steps per forcing cycle for fixed-step methods, as many as there are
        tolerances; the fewest steps take the place of the largest tolerance.

    Returns
    -------
    xarray.Dataset
        `verdict` for each (scene, verdict_method, method_tolerance). `right_from` for each (scene,
        verdict_method): the largest tolerance, or smallest number of steps, from which on all
        verdicts are right; NaN if the verdict at the strictest one is not.

    Raises
    ------
    TypeError, ValueError
        If an argument is not of its kind or out of range.
    """
    tolerances, steps = check_resolutions(tolerances, steps)
    shape = (len(scenes), len(LABELS), len(tolerances))
    found = np.full(shape, flag("verdict", "not_run"))
    limits = np.full(shape[:2], np.nan)
    for i, scene in enumerate(scenes.values()):
        for m, label in enumerate(LABELS):
            found[i, m], limits[i, m] = _by_resolution(label, scene, tolerances, steps)
    data = {
        "verdict": found,
        "right_from": limits,
        "verdict_steps": np.array(steps),
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
        "verdict_method": list(LABELS),
        "method_tolerance": tolerances,
    }
    return dataset(data, coordinates, {}, "Verdicts of each method by tolerance")
