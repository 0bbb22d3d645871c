"""The free motions at one frequency, which are the forced motions without the damper.

A search for motions with the damper must cover at least the displacements and speeds of the free
motions.

Z1 is the displacement of the primary mass, W the forcing frequency, and T the time.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.motions import ensemble, strobe_map, traces
from impact_damper.theory.free_oscillator import balance_amplitudes, maximum_response

# Number of phases at which starts with the amplitudes of harmonic balance are placed.
PHASES = 6
# SAMPLES      number of samples in a forcing cycle, which give the largest speed of a motion
# MOST_STATES  largest number of states stored of one motion; a chaotic motion has no period
SAMPLES = 256
MOST_STATES = 5


class FreeMotions(NamedTuple):
    """States and sizes of the free motions at one frequency.

    Attributes
    ----------
    states : numpy.ndarray, shape (k, 2)
        Z1, Z1' of each motion at W T = 0, once in each forcing cycle until the motion repeats, but
        at most MOST_STATES times.
    displacement, speed : float
        Largest |Z1| and |Z1'| of all these motions.
    """

    states: np.ndarray
    displacement: float
    speed: float


@lru_cache(1024)
def free_motions(oscillator, frequency, settling) -> FreeMotions:
    """Find the free motions at one frequency, by runs from start states.

    The starts are the state of rest, and states with the amplitudes of harmonic balance and of the
    resonance peak, each at PHASES phases. The amplitude of the peak leads to motions near a fold
    that harmonic balance does not predict.

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
    motions = ensemble.settle(np.tile(p, (len(starts), 1)), np.tile(starts, 2), settling)
    states, largest, fastest = [], 0.0, 0.0
    known = set()
    for record in motions[np.isfinite(motions["maximum_displacement"])]:
        key = record["outcome"], record["period"], f"{record['maximum_displacement']:.5e}"
        if key in known:
            continue
        known.add(key)
        course = _course(p, record["state"], int(record["period"]) or settling.watched)
        largest = max(largest, record["maximum_displacement"])
        fastest = max(fastest, np.max(np.abs(course[:, 1])))
        # The state is recorded at the phase W T = pi/2. T = 0 is three quarters of a cycle later.
        states.append(course[3 * SAMPLES // 4 :: SAMPLES, :2][:MOST_STATES])
    return FreeMotions(np.concatenate(states or [[(0.0, 0.0)]]), float(largest), float(fastest))


def _peak_amplitude(oscillator):
    """Return a list with the amplitude of the resonance peak, empty if there is no peak."""
    try:
        return [maximum_response(oscillator).amplitude]
    except ValueError:
        return []


def _course(p, state, periods):
    """Return samples of a free motion over `periods` cycles from a state at W T = pi/2."""
    begin = strobe_map.strobe_time(p)
    period = 2 * np.pi / p[FREQUENCY]
    times = begin + period * np.arange(periods * SAMPLES + 1) / SAMPLES
    states = np.empty((len(times), 4))
    none = np.empty((0, 5))
    traces.trace(p, state.copy(), begin, times, strobe_map.POLISH_TOLERANCE, states, none)
    return states
