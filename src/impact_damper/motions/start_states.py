"""Start states of a search for motions: random states, and states on known motions.

A start is an initial state. If the user gives a radius, all starts are random. They are uniform in
a ball, as in the paper (section 3, iii). With the option `whole_gap` the primary mass is in a disk
instead, and the loose mass anywhere in its gap. If the user gives no radius, there are random and
placed starts. The distances of random starts from rest are then uniform on a logarithmic scale, and
|Z1| and |Z1'| reach SPREAD times their largest values in motions without the damper. Placed starts
lie at rest, on motions without the damper, on solutions of harmonic balance, and at the end of
ramps. A ramp is a slow change of a parameter. A ramp can lead a weakly damped machine to a violent
motion to which random starts rarely lead.
"""

import math
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from impact_damper.model.bounds import FREQUENCY_RANGE, RADIUS_RANGE, check_number, warn
from impact_damper.model.families import FORCING
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import beyond_closed_forms
from impact_damper.motions import ensemble, strobe_map, traces
from impact_damper.motions.simulate import random_states
from impact_damper.theory.free_oscillator import balance_amplitudes, free_folds, maximum_response
from impact_damper.theory.single_harmonic import impacting_solutions

# Search for free motions. PHASES: number of starts on a solution of harmonic balance. SAMPLES:
# samples in a forcing cycle. MOST_STATES: largest number of states that are stored for one motion.
PHASES, SAMPLES, MOST_STATES = 6, 256, 5
# Random starts. |Z1| and |Z1'| of starts reach SPREAD times the largest values of free motions.
# SMALLEST: smallest distance of a start from rest, divided by the largest distance.
SPREAD, SMALLEST = 3.0, 0.01
# Placed starts. PLACES: Z2 divided by the clearance. VELOCITIES: Z2' divided by a speed. The speed
# is `_crossing_speed` for starts at rest. For starts on free motions it is the larger of
# `_crossing_speed` and the largest |Z1'| of the free motions.
PLACES, VELOCITIES = (-2 / 3, 0.0, 2 / 3), (-1.0, 0.0, 1.0)
# `sweep.stable_orbits` takes LOOSE_STATES random states of the loose mass. Their largest speed is
# LOOSE_SPEED times the larger of `_crossing_speed` and the largest |Z1'| of free motions.
LOOSE_STATES, LOOSE_SPEED = 240, 2.0
# Softening spring: |Z1|, |Z1'| of random starts are at most WITHIN times the results of `barrier`.
WITHIN = 0.7
NO_STARTS, NO_LOOSE = np.empty((0, 4)), np.empty((0, 2))
# Ramps. STEP: relative change of the parameter in a step. PERIODS: forcing cycles in a step.
# RAISED: in a ramp of the force, the first force divided by the last force. BELOW: the upward ramp
# to the frequency W begins at BELOW times the lowest of W/2 and all fold frequencies. The downward
# ramp begins at 1/BELOW times the highest of 2 W and all fold frequencies.
STEP, PERIODS, BELOW, RAISED = 0.0125, 20, 0.9, 5.0


class Search(NamedTuple):
    """Start states at T = 0 for n systems (damper, W), and the sizes of starts and free motions.

    `random` (n, m, 4) holds m random starts for each system. `placed` and `loose` hold one array
    for each system, which is empty if a radius is given. `loose` has states of the loose mass for
    `sweep.stable_orbits`. `displacement` and `speed` (n,) bound |Z1| and |Z1'| of random starts.
    `free_displacement` and `free_speed` (n,) are the largest |Z1| and |Z1'| of the free motions.
    """

    random: np.ndarray
    placed: list
    loose: list
    displacement: np.ndarray
    speed: np.ndarray
    free_displacement: np.ndarray
    free_speed: np.ndarray

    def variables(self, dimension=None) -> dict:
        """Return the missed share and the last four fields, over `dimension` or as scalars."""
        names = "start_displacement", "start_speed", "free_displacement", "free_speed"
        data = {
            name: ((), values[0]) if dimension is None else (dimension, values)
            for name, values in zip(names, self[3:], strict=True)
        }
        return data | {"missed_share": missed_share(self.random.shape[1])}


def search_starts(oscillator, systems, count, radius, seed, settling, *, whole_gap=False) -> Search:
    """Return a `Search` with `count` random starts for each of `systems`: (damper or None, W)."""
    if radius is None:
        numbered = enumerate(systems)
        rows = [wide_starts(oscillator, *each, count, [seed, i], settling) for i, each in numbered]
    else:
        frequencies = [frequency for _, frequency in systems]
        drawn = gap_states if whole_gap else random_states
        free = free_sizes(oscillator, frequencies)
        if not whole_gap:  # otherwise starts near rest are wanted
            warn_if_narrow(oscillator, frequencies, radius)
        rows = []
        for i, (damper, w) in enumerate(systems):
            states = drawn(count, radius, damper, [seed, i])
            rows.append((states, NO_STARTS, NO_LOOSE, radius, radius, *free[w]))
    random, placed, loose, *scales = zip(*rows, strict=True)
    return Search(np.array(random), list(placed), list(loose), *np.array(scales))


def describe_search(starts, radius, seed, whole_gap=False) -> dict:
    """Return the arguments of a search, for storage in a dataset. Unused arguments are left out."""
    parameters = {"starts": starts, "seed": seed} | ({"whole_gap": True} if whole_gap else {})
    return parameters if radius is None else parameters | {"radius": radius}


def missed_share(starts) -> float:
    """Return the 95 % bound, 3/starts, on the share of starts that lead to motions not found."""
    return min(1.0, 3.0 / starts) if starts else 1.0


def free_sizes(oscillator, frequencies) -> dict:
    """Return max |Z1| and max |Z1'| of free motions by harmonic balance, for each frequency."""
    sizes = {w: float(balance_amplitudes(oscillator, w)[-1]) for w in dict.fromkeys(frequencies)}
    return {w: (size, size * w) for w, size in sizes.items()}


def warn_if_narrow(oscillator, frequencies, radius) -> None:
    """Warn if |Z1| or |Z1'| of a free motion exceeds the radius of the ball of starts."""
    check_number("radius", radius, **RADIUS_RANGE)
    sizes = free_sizes(oscillator, frequencies)
    worst = max(sizes, key=lambda w: max(sizes[w]))
    most, fastest = sizes[worst]
    if max(most, fastest) > radius:
        told = oscillator.scales.told
        warn(
            f"{told('radius', radius, 'displacement')}: smaller than the free motion at "
            f"{told('frequency', worst, 'frequency')}, with "
            f"{told('displacement', most, 'displacement')} and "
            f"{told('speed', fastest, 'velocity')} by harmonic balance; motions may be missed; "
            "without a radius the search is scaled by the free motions",
        )


def gap_states(count, radius, damper, seed):
    """Return random states: (Z1, Z1') in a disk, and the loose mass at relative rest in its gap."""
    states = radius * random_states(count, 1.0, None, seed)
    if damper is not None:
        generator = np.random.default_rng(np.append(seed, count))
        states[:, 2] = damper.clearance * generator.uniform(-1, 1, count)
        states[:, 3] = 0.0
    return states


def wide_starts(oscillator, damper, frequency, count, seed, settling) -> tuple:
    """Return the fields of a `Search` for one system, in the case that no radius is given."""
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
    """Return random starts (count, 4), and the bounds on their |Z1| and |Z1'|.

    The bounds follow from |Z1| and |Z1'| of the free motions, which are run with `settling`.
    """
    generator = np.random.default_rng(seed)
    free = free_motions(oscillator, frequency, settling)
    crossing = 0.0 if damper is None else _crossing_speed(damper, frequency)
    length = free.displacement or (1.0 if damper is None else damper.clearance)
    most = np.array([length, free.speed or max(length * frequency, crossing)]) * SPREAD
    if oscillator.softens:
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
    """Return the speed at which the loose mass crosses the gap in half a forcing cycle."""
    return 2 * damper.clearance * frequency / math.pi


def _placed(oscillator, damper, frequency, free, crossing, tolerance):
    rows = ramped(oscillator, damper, frequency, tolerance) + [
        (x, v, place * damper.clearance, velocity * speed)
        for primary, speed in [(free.states, max(free.speed, crossing)), ([(0.0, 0.0)], crossing)]
        for x, v in primary
        for place in PLACES
        for velocity in VELOCITIES
    ]
    if beyond_closed_forms(oscillator, damper):
        return np.array(rows)
    try:
        # Starts need not be exact, so the solutions for elastic contact suffice.
        solutions = impacting_solutions(oscillator, replace(damper, restitution=1.0), frequency)
    except ArithmeticError:
        return np.array(rows)
    turn = np.array([np.cos(solutions.phase), -frequency * np.sin(solutions.phase)])
    sizes = solutions.amplitude, solutions.relative_amplitude
    return np.concatenate([rows, np.vstack([size * turn for size in sizes]).T])


def ramped(oscillator, damper, frequency, tolerance) -> list:
    """Return states at T = 0 after ramps of frequency or force. Escaped motions are left out."""
    folds = [fold.frequency for fold in free_folds(oscillator)] or [frequency]
    lowest = max(BELOW * min(frequency / 2, *folds), FREQUENCY_RANGE["least"])
    highest = min(max(2 * frequency, *folds) / BELOW, FREQUENCY_RANGE["most"])
    target = pack(oscillator, damper, frequency)
    ramps = [_ramp(target, [FREQUENCY], w / frequency, tolerance) for w in (lowest, highest)]
    ramps.append(_ramp(target, list(FORCING.values()), RAISED, tolerance))
    return [state for state in ramps if np.isfinite(state).all()]


def _ramp(target, indices, factor, tolerance):
    p, state, none = target.copy(), np.zeros(4), np.empty((0, 4))
    for exponent in np.linspace(1, 0, 2 + math.ceil(abs(math.log(factor)) / STEP)):
        p[indices] = target[indices] * factor**exponent
        begin = strobe_map.strobe_time(p)
        strobe_map.flow(p, state, none, begin, PERIODS, np.bool_(False), tolerance)
        if not np.isfinite(state).all():
            return state
    begin, end = strobe_map.strobe_time(target), 2 * np.pi / target[FREQUENCY]
    return traces.states_at(target, state, begin, [end], tolerance)[0]


def barrier(oscillator):
    """Return |Z1| at a softening spring's barrier, and the speed at Z1 = 0 that just reaches it."""
    stiffness, softening = oscillator.linear_frequency**2, -oscillator.cubic
    return math.sqrt(stiffness / softening), stiffness / math.sqrt(2 * softening)


class FreeMotions(NamedTuple):
    """States (Z1, Z1') of free motions at W T = 0; largest |Z1| and |Z1'| in all these motions."""

    states: np.ndarray
    displacement: float
    speed: float


@lru_cache(1024)
def free_motions(oscillator, frequency, settling) -> FreeMotions:
    """Find the free motions at one frequency W, by runs from rest and from harmonic balance."""
    p = pack(oscillator, None, frequency)
    angles = 2 * np.pi * np.arange(PHASES) / PHASES
    sizes = list(balance_amplitudes(oscillator, frequency))
    # Near a fold harmonic balance can miss motions, so runs also start at the peak amplitude.
    with suppress(ValueError):  # raised if there is no peak
        sizes.append(maximum_response(oscillator).amplitude)
    turns = np.stack([np.cos(angles), -frequency * np.sin(angles)], axis=1)
    starts = np.concatenate([[(0.0, 0.0)], *(size * turns for size in sizes)])
    motions = ensemble.settle(np.tile(p, (len(starts), 1)), np.tile(starts, 2), settling)
    states, largest, fastest = [], 0.0, 0.0
    known, begin, period = set(), strobe_map.strobe_time(p), 2 * np.pi / frequency
    for record in motions[np.isfinite(motions["maximum_displacement"])]:
        key = record["outcome"], record["period"], f"{record['maximum_displacement']:.5e}"
        if key in known:
            continue
        known.add(key)
        cycles = int(record["period"]) or settling.watched
        times = begin + period * np.arange(cycles * SAMPLES + 1) / SAMPLES
        course = traces.states_at(p, record["state"], begin, times, strobe_map.POLISH_TOLERANCE)
        largest = max(largest, record["maximum_displacement"])
        fastest = max(fastest, np.max(np.abs(course[:, 1])))
        # The record's state is at W T = pi/2. The phase 0 is three quarters of a cycle later.
        states.append(course[3 * SAMPLES // 4 :: SAMPLES, :2][:MOST_STATES])
    return FreeMotions(np.concatenate(states or [[(0.0, 0.0)]]), float(largest), float(fastest))
