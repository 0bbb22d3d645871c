"""Rigid impacts, the limit of (20) to (25) for infinite r1, and orbits with rigid impacts."""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import acceleration
from impact_damper.kernel.instances import FLIGHT_ORDER
from impact_damper.kernel.single import X, extremum, workspace
from impact_damper.kernel.tangents import step_with_tangents
from impact_damper.model.exit_rules import damping_ratio
from impact_damper.model.packed import (
    CLEARANCE,
    DAMPING,
    DASHPOT,
    FREQUENCY,
    INVERSE_MASS_RATIO,
    pack,
)
from impact_damper.motions.strobe_map import CONVERGED, POLISH_TOLERANCE, strobe_time

# A run stops after MOST_IMPACTS impacts in a cycle. If e < 1, infinitely many are possible.
MOST_IMPACTS = 200
ITERATIONS = 12  # largest number of steps of Newton's method
SAME_SPEED = 1e-6  # largest relative difference of the two approach speeds in a symmetric orbit


@kernel
def rebound(p, restitution, y, tangents, t):
    """Apply an instantaneous impact to a state y and to small changes of the state, in place.

    Each row of `tangents` is a vector d with small changes of Z1, Z1', Z2 and Z2' before the
    impact. Let a be the acceleration of Z1 before the impact, h the damping and
    k = (1 + e)/(1 + 1/rm). The impact changes Z1' to Z1' - k Z2', Z2' to -e Z2', and d to S d with

        S = [1 0 -k 0; 0 1 k (a/Z2' + h) -k; 0 0 -e 0; 0 0 (1 + e) a/Z2' + h k -e].
    """
    gain = (1.0 + restitution) / (1.0 + p[INVERSE_MASS_RATIO])
    speed = y[3]
    pull = acceleration(p, y, t) / speed
    for i in range(tangents.shape[0]):
        d = tangents[i]
        shift, relative = d[2], d[3]
        d[0] -= gain * shift
        d[1] += gain * ((pull + p[DAMPING]) * shift - relative)
        d[2] = -restitution * shift
        d[3] = ((1.0 + restitution) * pull + p[DAMPING] * gain) * shift - restitution * relative
    y[1] -= gain * speed
    y[3] = -restitution * speed


@kernel
def rigid_map(p, restitution, y, tolerance):
    """Integrate the rigid model over one forcing cycle from the state y at W T = pi/2.

    The walls in p must have no dashpot. Return the final state, its derivative by y, the number of
    impacts, the smallest |Z2'| before an impact (or infinity), a pair for the first impact, and max
    |Z1|. The pair holds |Z2'| and the acceleration of Z1 towards the wall just before the impact
    (or NaN). After MOST_IMPACTS impacts, only the number of impacts is valid.
    """
    state = y.copy()
    tangents = np.eye(4)
    work = workspace()
    flight = np.int64(0)  # not the literal 0, for which numba would compile the step again
    t = strobe_time(p)
    end = t + 2.0 * math.pi / p[FREQUENCY]
    impacts, speed, first, largest = 0, math.inf, (math.nan, math.nan), abs(y[0])
    while t < end and impacts < MOST_IMPACTS:
        length, side = step_with_tangents(p, state, tangents, flight, t, end - t, tolerance, work)
        # At an impact Z1' jumps, so |Z1| can be largest there too.
        largest = max(extremum(work[X:], FLIGHT_ORDER, length, largest), abs(state[0]))
        t = end if length >= end - t else t + length
        if side != 0:
            if impacts == 0:
                first = abs(state[3]), side * acceleration(p, state, t)
            speed = min(speed, abs(state[3]))
            impacts += 1
            rebound(p, restitution, state, tangents, t)
    return state, tangents.T.copy(), impacts, speed, first, largest


def without_dashpot(p):
    """Return a copy of packed parameters in which the walls have no dashpot."""
    p = p.copy()
    p[DASHPOT] = 0.0
    return p


class RigidOrbit(NamedTuple):
    """A symmetric orbit with 2 impacts a cycle. `speed` is |Z2'| just before an impact."""

    state: np.ndarray
    multiplier: complex
    displacement: float
    speed: float
    acceleration: float
    maps: int
    p: np.ndarray
    restitution: float


def rigid_orbit(oscillator, damper, frequency, guess, reach):
    """Return the `RigidOrbit` near the state `guess`, or None, and a status.

    The state of the orbit differs from the guess by less than `reach`. The status is "found";
    "not_followed" if Newton's method fails; "other_contacts" if there are not two symmetric
    impacts; "chatter" if there are MOST_IMPACTS impacts in a cycle.
    """
    return _solve(pack(oscillator, damper, frequency), damper.restitution, guess, reach)


def mended_orbit(oscillator, damper, frequency, orbit, reach):
    """Return the `RigidOrbit` between corrected walls, or None, and a status.

    Corrected walls imitate compliant walls (`docs/explanation/methods.md`). `orbit` is the orbit
    between uncorrected walls. Its state and that of the result differ by less than `reach`.
    """
    e, h, v, before = damper.restitution, oscillator.damping, orbit.speed, orbit.acceleration
    reduced = damper.mass_ratio / (1 + damper.mass_ratio)
    z, natural = damping_ratio(e), damper.contact_frequency
    duration = np.pi / (natural * np.sqrt(1 - z * z))
    shift = v * duration * e / (1 + e)
    after = before + h * (1 + e) * reduced * v
    load = (before + h * reduced * v) / (natural * v)
    damped = e * np.pi * h * reduced / (2 * natural * (1 - z * z) ** 1.5)
    returned = e - damped - 2 * z * (1 + e) * load
    p = pack(oscillator, damper, frequency)
    p[CLEARANCE] = damper.clearance + shift
    restitution = returned + shift / v**2 * (after / e - e * before)
    return _solve(p, restitution, orbit.state, reach)


def _solve(p, restitution, guess, reach):
    p = without_dashpot(p)
    restitution = float(restitution)  # numba would compile the map a second time for an int
    y = np.array(guess, float)
    for k in range(ITERATIONS):
        state, matrix, impacts, slowest, first, largest = rigid_map(
            p, restitution, y, POLISH_TOLERANCE
        )
        if impacts == MOST_IMPACTS:
            return None, "chatter"
        if impacts == 0:
            break
        change = np.linalg.solve(np.eye(4) - matrix, state - y)
        if np.max(np.abs(change)) < CONVERGED:
            if impacts != 2 or abs(first[0] - slowest) > SAME_SPEED * first[0]:
                return None, "other_contacts"
            values = np.linalg.eigvals(matrix)
            largest_value = values[np.argmax(np.abs(values))]
            dominant = complex(largest_value.real, abs(largest_value.imag))
            return RigidOrbit(y, dominant, largest, *first, k + 1, p, restitution), "found"
        y = y + change
        if not np.max(np.abs(y - guess)) < reach:
            break
    return None, "not_followed"
