"""The free motions, those without the damper, at one frequency.

A search for motions with the damper must cover at least their displacements and speeds.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from impact_damper.motions import ensemble, records, strobe_map
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.theory.free_oscillator import balance_amplitudes, maximum_response

# Phases at which free motions are started with the amplitudes of harmonic balance.
PHASES = 6
# Samples per forcing period from which the largest speed of a motion is taken, and most states that
# are kept of one motion, which may be chaotic.
SAMPLES = 256
MOST_STATES = 5


class FreeMotions(NamedTuple):
    """What the free oscillator does at one frequency.

    Attributes
    ----------
    states : numpy.ndarray, shape (k, 2)
        Z1, Z1' of each distinct motion at T = 0, and at every later forcing period of its period.
    displacement, speed : float
        Largest |Z1| and |Z1'| of all these motions.
    """

    states: np.ndarray
    displacement: float
    speed: float


@lru_cache(1024)
def free_motions(oscillator, frequency, settling) -> FreeMotions:
    """Find the free motions at one frequency, by running start states until they settle.

    Starts are the state of rest, and the amplitudes of harmonic balance and of the resonance peak,
    each at PHASES phases. Thus motions near a fold are found that harmonic balance does not
    predict.

    Parameters
    ----------
    oscillator : Oscillator
    frequency : float
        W.
    settling : Settling
    """
    p = pack(oscillator, None, frequency)
    angles = 2 * np.pi * np.arange(PHASES) / PHASES
    sizes = np.append(balance_amplitudes(oscillator, frequency), _peak_amplitude(oscillator))
    turns = np.stack([np.cos(angles), -frequency * np.sin(angles)], axis=1)
    starts = np.concatenate([[(0.0, 0.0)], *(size * turns for size in sizes)])
    found = ensemble.settle(np.tile(p, (len(starts), 1)), np.tile(starts, 2), settling)
    states, largest, fastest = [], 0.0, 0.0
    known = set()
    for record in found[np.isfinite(found["maximum_displacement"])]:
        key = record["outcome"], record["period"], f"{record['maximum_displacement']:.5e}"
        if key in known:
            continue
        known.add(key)
        course = _course(p, record["state"], int(record["period"]) or settling.watched)
        largest = max(largest, record["maximum_displacement"])
        fastest = max(fastest, np.max(np.abs(course[:, 1])))
        # T = 0 comes three quarters of a period after the strobe
        states.append(course[3 * SAMPLES // 4 :: SAMPLES, :2][:MOST_STATES])
    return FreeMotions(np.concatenate(states or [[(0.0, 0.0)]]), float(largest), float(fastest))


def _peak_amplitude(oscillator):
    """Return a list with the amplitude of the resonance peak, empty if there is no peak."""
    try:
        return [maximum_response(oscillator).amplitude]
    except ValueError:
        return []


def _course(p, state, periods):
    """Return samples of a free motion during some forcing periods from a state at the strobe."""
    begin = strobe_map.strobe_time(p)
    period = 2 * np.pi / p[FREQUENCY]
    times = begin + period * np.arange(periods * SAMPLES + 1) / SAMPLES
    states = np.empty((len(times), 4))
    none = np.empty((0, 5))
    records.trace(p, state.copy(), begin, times, strobe_map.POLISH_TOLERANCE, states, none)
    return states
