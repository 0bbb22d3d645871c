"""Start states from which motions are searched for: random ones, and on known free motions.

If no radius is given, a search is as wide as the machine: it is scaled by the largest displacement
and speed of the motions without the damper (free motions) at the frequency. These motions are
simulated until they settle (`free_motions`); harmonic balance only provides states to start them
from. The starts are of two kinds:

- random: the primary mass anywhere up to SPREAD times these scales, with sizes spread evenly over
  their logarithm, so that small and large motions are tried alike;
- placed: the primary mass on each free motion and at rest, the loose mass in several places with
  several velocities; the solutions of harmonic balance with contacts; and the ends of slow ramps of
  the frequency, upward and downward, and of the force, downward, to the values of the system. On a
  ramp a motion stays on its branch, so that ramps reach the violent motions of weakly damped
  machines, whose basins are so small that hardly a random start lies in them.

Newton's method then looks for stable orbits beside the motions found (`orbit_search`), from random
states of the loose mass.

If a radius is given, all starts are random, uniform in a ball as in the paper (section 3, iii).
"""

import math
import warnings
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from impact_damper.motions import records, strobe_map
from impact_damper.motions.free_motions import free_motions
from impact_damper.motions.simulate import random_states
from impact_damper.system.bounds import FREQUENCY_RANGE, RADIUS_RANGE, check_number
from impact_damper.system.families import FORCING
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.theory.free_oscillator import balance_amplitudes, free_folds
from impact_damper.theory.single_harmonic import impacting_solutions

# Ratios: largest random start to largest free motion, and smallest to largest random start.
SPREAD = 3.0
SMALLEST = 0.01
# Placed starts: Z2 divided by the clearance, and Z2' divided by the speed of the free motion or, if
# larger, by the speed that crosses the gap in half a forcing period.
PLACES = (-2 / 3, 0.0, 2 / 3)
VELOCITIES = (-1.0, 0.0, 1.0)
# States of the loose mass from which Newton's method looks for orbits, and largest velocity of the
# loose mass in them, divided as that of the placed starts.
LOOSE_STATES = 240
LOOSE_SPEED = 2.0
# With a softening spring, largest random start divided by displacement and speed at the barrier.
# The energy of a start is then at most three quarters of that at the barrier: starts with more
# would go over it by themselves.
WITHIN = 0.7
NO_STARTS, NO_LOOSE = np.empty((0, 4)), np.empty((0, 2))
# Ramps: relative change of a parameter in one step; forcing periods per step; ratio of the first
# frequency to the lowest fold (its inverse for the highest fold); ratio of the first force to the
# last.
STEP = 0.0125
PERIODS = 20
BELOW = 0.9
RAISED = 5.0
# If n random starts all miss a motion, its share of starts is, at 95 %, at most RULE_OF_THREE/n.
RULE_OF_THREE = 3.0


class Search(NamedTuple):
    """Start states of a search at several systems.

    Attributes
    ----------
    random : numpy.ndarray, shape (n, m, 4)
        Random starts at T = 0.
    placed : list of numpy.ndarray, shape (k, 4)
        Placed starts at T = 0 of each system; none if a radius is given.
    loose : list of numpy.ndarray, shape (k, 2)
        States of the loose mass of each system, as `orbit_search.stable_orbits` takes them; none if
        a radius is given.
    displacement, speed : numpy.ndarray, shape (n,)
        Largest |Z1| and |Z1'| of a random start.
    free_displacement, free_speed : numpy.ndarray, shape (n,)
        Largest |Z1| and |Z1'| of the free motions; by harmonic balance if a radius is given.
    """

    random: np.ndarray
    placed: list
    loose: list
    displacement: np.ndarray
    speed: np.ndarray
    free_displacement: np.ndarray
    free_speed: np.ndarray

    def variables(self, dimension=None) -> dict:
        """Return registered variables on how wide the search was, along `dimension` if given."""
        names = "start_displacement", "start_speed", "free_displacement", "free_speed"
        data = {
            name: ((), values[0]) if dimension is None else (dimension, values)
            for name, values in zip(names, self[3:], strict=True)
        }
        return data | {"missed_share": missed_share(self.random.shape[1])}


def describe_search(starts, radius, seed) -> dict:
    """Return the parameters of a search for a dataset; the radius only if there is one."""
    made = {"starts": starts, "seed": seed}
    return made if radius is None else made | {"radius": radius}


def missed_share(starts) -> float:
    """Return the bound, at 95 %, on the share of starts that lead to a motion never seen."""
    return min(1.0, RULE_OF_THREE / starts) if starts else 1.0


def search_starts(oscillator, systems, count, radius, seed, settling) -> Search:
    """Return the starts of a search; if a radius is given, warn as `warn_if_narrow` does.

    Parameters
    ----------
    oscillator : Oscillator
    systems : list of tuple
        Damper or None, and frequency W, of each system.
    count : int
        Random starts of each system.
    radius : float or None
        Radius of the ball of random starts; None for a search as wide as the machine.
    seed : int
        Each system has random starts of its own, drawn with the seed and its place in `systems`.
    settling : Settling
        How free motions are settled.

    Raises
    ------
    TypeError, ValueError
        If count, radius or seed is out of range.
    """
    if radius is None:
        rows = [
            wide_starts(oscillator, *system, count, [seed, i], settling)
            for i, system in enumerate(systems)
        ]
    else:
        frequencies = [frequency for _, frequency in systems]
        free = warn_if_narrow(oscillator, frequencies, radius)
        rows = [
            (
                random_states(count, radius, damper, [seed, i]),
                NO_STARTS,
                NO_LOOSE,
                radius,
                radius,
                *free[w],
            )
            for i, (damper, w) in enumerate(systems)
        ]
    random, placed, loose, *scales = zip(*rows, strict=True)
    return Search(np.array(random), list(placed), list(loose), *np.array(scales))


def warn_if_narrow(oscillator, frequencies, radius) -> dict:
    """Return displacement and speed of the largest free motion, keyed by frequency, and warn.

    Both follow from harmonic balance, in which the speed is W times the displacement.

    Warns
    -----
    UserWarning
        If a free motion is larger or faster than the radius of the ball of starts.
    """
    check_number("radius", radius, **RADIUS_RANGE)
    sizes = {w: float(balance_amplitudes(oscillator, w)[-1]) for w in dict.fromkeys(frequencies)}
    worst = max(sizes, key=lambda w: sizes[w] * max(1.0, w))
    most, fastest = sizes[worst], sizes[worst] * worst
    if max(most, fastest) > radius:
        warnings.warn(
            f"radius = {radius:g}: smaller than the free motion at frequency = {worst:g}, with "
            f"displacement = {most:.3g} and speed = {fastest:.3g} by harmonic balance; motions "
            "may be missed, without a radius a search is as wide as the machine",
            stacklevel=4,
        )
    return {w: (size, size * w) for w, size in sizes.items()}


def wide_starts(oscillator, damper, frequency, count, seed, settling) -> tuple:
    """Return one system's values of the fields of `Search`, in their order, without a radius."""
    free = free_motions(oscillator, frequency, settling)
    states, most = random_starts(oscillator, damper, frequency, count, seed, settling)
    if damper is None:
        placed, loose = np.hstack([free.states, free.states]), NO_LOOSE
    else:
        crossing = _crossing_speed(damper, frequency)
        placed = _placed(oscillator, damper, frequency, free, crossing, settling.tolerance)
        fastest = LOOSE_SPEED * max(free.speed, crossing)
        generator = np.random.default_rng(np.append(seed, LOOSE_STATES))
        loose = generator.uniform(-1, 1, (LOOSE_STATES, 2)) * (damper.clearance, fastest)
    return states, placed, loose, *most, free.displacement, free.speed


def random_starts(oscillator, damper, frequency, count, seed, settling) -> tuple:
    """Return the random starts of a search as wide as the machine, and how wide it is.

    Parameters
    ----------
    oscillator, damper, frequency
        Of one system.
    count : int
    seed : int or sequence of int
    settling : Settling
        How free motions are settled.

    Returns
    -------
    states : numpy.ndarray, shape (count, 4)
    most : numpy.ndarray, shape (2,)
        Largest |Z1| and |Z1'| of a start.
    """
    generator = np.random.default_rng(seed)
    free = free_motions(oscillator, frequency, settling)
    crossing = 0.0 if damper is None else _crossing_speed(damper, frequency)
    length = free.displacement or (1.0 if damper is None else damper.clearance)
    most = np.array([length, free.speed or max(length * frequency, crossing)]) * SPREAD
    if oscillator.cubic < 0:
        most = np.minimum(most, WITHIN * np.array(barrier(oscillator)))
    size = 2 if damper is None else 3
    direction = generator.standard_normal((count, size))
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    direction *= SMALLEST ** generator.random((count, 1))
    states = np.empty((count, 4))
    states[:, :2] = most * direction[:, :2]
    if damper is None:
        states[:, 2:] = states[:, :2]
    else:
        states[:, 2] = damper.clearance * generator.uniform(-1, 1, count)
        states[:, 3] = (most[1] + crossing) * direction[:, 2]
    return states, most


def _crossing_speed(damper, frequency):
    """Return the speed at which the loose mass crosses its gap in half a forcing period."""
    return 2 * damper.clearance * frequency / math.pi


def _placed(oscillator, damper, frequency, free, crossing, tolerance):
    """Return starts on free motions, at rest, after ramps, and on the solutions of (7)."""
    rows = ramped(oscillator, damper, frequency, tolerance) + [
        (x, v, place * damper.clearance, velocity * speed)
        for primary, speed in [(free.states, max(free.speed, crossing)), ([(0.0, 0.0)], crossing)]
        for x, v in primary
        for place in PLACES
        for velocity in VELOCITIES
    ]
    try:
        # they are starts only, so that those for elastic contact serve all dampers
        found = impacting_solutions(oscillator, replace(damper, restitution=1.0), frequency)
    except ArithmeticError:
        return np.array(rows)
    turn = np.array([np.cos(found.phase), -frequency * np.sin(found.phase)])
    sizes = found.amplitude, found.relative_amplitude
    return np.concatenate([rows, np.vstack([size * turn for size in sizes]).T])


def ramped(oscillator, damper, frequency, tolerance) -> list:
    """Return states at T = 0 at the ends of slow ramps; none where a motion has escaped.

    The frequency rises from below the lowest fold of the free response and falls from above its
    highest one, from half and twice the frequency at least; the force falls from RAISED times its
    value.
    """
    folds = [fold.frequency for fold in free_folds(oscillator)] or [frequency]
    lowest = max(BELOW * min(frequency / 2, *folds), FREQUENCY_RANGE["least"])
    highest = min(max(2 * frequency, *folds) / BELOW, FREQUENCY_RANGE["most"])
    target = pack(oscillator, damper, frequency)
    ramps = [
        _ramp(target, [FREQUENCY], lowest / frequency, tolerance),
        _ramp(target, [FREQUENCY], highest / frequency, tolerance),
        _ramp(target, list(FORCING.values()), RAISED, tolerance),
    ]
    return [state for state in ramps if np.isfinite(state).all()]


def _ramp(target, indices, factor, tolerance):
    """Return the state at T = 0 after a ramp from rest.

    The packed parameters with some indices go from `factor` times their values to these values.
    """
    p, state, none = target.copy(), np.zeros(4), np.empty((0, 4))
    for share in np.linspace(1, 0, 2 + math.ceil(abs(math.log(factor)) / STEP)):
        p[indices] = target[indices] * factor**share
        begin = strobe_map.strobe_time(p)
        strobe_map.flow(p, state, none, begin, PERIODS, np.bool_(False), tolerance)
        if not np.isfinite(state).all():
            return state
    end, at_zero = np.array([2 * np.pi / target[FREQUENCY]]), np.empty((1, 4))
    begin = strobe_map.strobe_time(target)
    records.trace(target, state, begin, end, tolerance, at_zero, np.empty((0, 5)))
    return at_zero[0]


def barrier(oscillator):
    """Return |Z1| at the barrier of a softening spring, and the speed at Z1 = 0 that reaches it."""
    stiffness, softening = oscillator.linear_frequency**2, -oscillator.cubic
    return math.sqrt(stiffness / softening), stiffness / math.sqrt(2 * softening)
