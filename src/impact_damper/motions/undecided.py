"""Continue the motions with the outcome UNRESOLVED, to find what kind of motions they are.

A quasi-periodic motion is recognised by its strobe states: they lie on n closed curves, n = 1, 2,
..., and every n-th state lies on the same curve. From each state on a curve to the next, the angle
around the curve's centre advances. The rotation number is the mean of these advances, in
revolutions. Here the weights of the mean fall smoothly to 0 at the first and the last state. Then
the mean over m states converges faster than any power of 1/m (S. Das, Y. Saiki, E. Sander and
J. A. Yorke, Nonlinearity 30, 4111-4140, 2017). In a chaotic motion it converges as m^(-1/2) only.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import forcing_amplitude, has_escaped
from impact_damper.kernel.single import assign, side_of, workspace
from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.motions import records
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, one_period, polish
from impact_damper.motions.watch import CONFIDENCE, LONGEST_PERIOD, NEAR, normalise

# A motion is run in blocks. FIRST: largest number of forcing cycles in the first block. A block has
# BATCHES parts. Each part gives a Lyapunov exponent. Their scatter gives the error of the mean.
FIRST, BATCHES = 1500, 30
# A motion is chaotic only if its tangent grows in a block by more than the factor exp(GROWN). While
# a motion leaves an unstable orbit, a rounding error grows by less, about 1e16 = exp(37).
GROWN = 40.0
# A Lyapunov exponent counts as 0 if its modulus is at most NEUTRAL standard errors.
NEUTRAL = 3.0
# LONGEST: longest period of an orbit that Newton's method looks for, in forcing cycles.
# REACH: Newton's method fails if it changes Z1, Z1' or Z2 by this much or more.
LONGEST, REACH = 256, 1e-2
# A state lies on a known closed curve if it is nearer than this to a known point of the curve.
NEIGHBOUR = 1e-3
# Fields that are copied from a known quasi-periodic motion to a motion on the same closed curves.
TORUS = ["outcome", "lyapunov_exponent", "lyapunov_error"]
TORUS += ["first_frequency", "second_frequency", "frequency_error"]
# AGREEMENT: largest error with which a rotation number is accepted.
# FEWEST: smallest number of points from which a rotation number is computed.
AGREEMENT, FEWEST = 1e-8, 100
# Advances of an angle are known modulo 1 revolution. `find_rotation` averages them only if some
# interval of at least this length, in revolutions modulo 1, contains no advance.
INTERVAL = 0.02
# `find_rotation` rejects a curve if the angle around its centre, in revolutions, changes by TURN or
# more between points next to each other on the curve. It also rejects a curve if the moduli of all
# these changes have a sum of WANDERING or more.
TURN, WANDERING = 0.05, 3.0


@kernel
def run_block(p, y, tangent, states, growth, stop):
    """Run a motion and its `tangent` (1, 4) for len(states) forcing cycles.

    states[k] receives the state after cycle k, and growth[k] the logarithm of the factor by which
    the tangent grows in cycle k. Return the number of contacts and whether the motion escapes.
    """
    work = workspace()
    side = side_of(p, y)
    total = 1 if side != 0 else 0
    for k in range(len(states)):
        if stop[0]:
            break
        side, contacts, _ = one_period(p, y, tangent, side, POLISH_TOLERANCE, work)
        total += contacts
        if has_escaped(p, y[0], y[1]):
            return total, True
        assign(states[k], y)
        growth[k] = normalise(tangent[0])
    return total, False


def name_undecided(parameters, motions, limit, further, stop):
    """Continue the forced motions that have the outcome UNRESOLVED; complete their records.

    A motion runs in blocks, for at most `further` cycles in all. The first block has `limit` cycles
    or FIRST, whichever is less. Each further block is twice as long as the block before.
    """
    curves = []
    for i in np.flatnonzero(motions["outcome"] == records.UNRESOLVED):
        p, record = parameters[i], motions[i : i + 1]
        if forcing_amplitude.py_func(p) > 0:
            known = [curve for curve in curves if np.array_equal(curve.parameters, p)]
            states = _name_one(p, record, limit, further, known, stop)
            if record["outcome"] == records.QUASI_PERIODIC:
                curves.append(_Curves(p, states, record.copy()))


class _Curves(NamedTuple):
    parameters: np.ndarray
    states: np.ndarray
    record: np.ndarray


def _name_one(p, record, limit, further, known, stop):
    y, tangent = record["state"][0].copy(), np.full((1, 4), 0.5)
    period, count = 2 * math.pi / p[FREQUENCY], min(limit, FIRST)
    states = np.empty((LONGEST_PERIOD, 4))
    if known:
        run_block(p, y.copy(), tangent.copy(), states, np.empty(LONGEST_PERIOD), stop)
        if _is_known(record, known, states):
            return states
    while count <= further:
        states, growth = np.empty((count, 4)), np.empty(count)
        contacts, escaped = run_block(p, y, tangent, states, growth, stop)
        record["periods_run"] += count
        record["state"] = y
        if stop[0]:
            break
        if escaped or not np.all(np.isfinite(y)):
            record["outcome"] = records.ESCAPED if escaped else records.DIVERGED
            break
        far = np.max(np.hypot(states[:, 0], states[:, 1] / p[FREQUENCY]))
        record["reach"] = np.maximum(record["reach"], far)
        mean, error = _exponent(growth)
        record["lyapunov_exponent"], record["lyapunov_error"] = mean / period, error / period
        if _is_known(record, known, states[-LONGEST_PERIOD:]):
            break
        record["outcome"] = (
            _on_orbit(p, record, states, contacts, limit)
            or _quasi_periodic(p, record, states, mean, error)
            or (records.CHAOTIC if _grows(growth, mean, error) else records.UNRESOLVED)
        )
        if record["outcome"] != records.UNRESOLVED:
            break
        further, count = further - count, 2 * count
    return states


def _is_known(record, known, states):
    for curves in known:
        apart = np.abs(states[:, None, :3] - curves.states[None, :, :3]).max(axis=2)
        if np.max(np.min(apart, axis=1)) < NEIGHBOUR:
            for name in TORUS:
                record[name] = curves.record[name]
            return True
    return False


def _exponent(growth):
    length = len(growth) // BATCHES
    batches = growth[-BATCHES * length :].reshape(BATCHES, length).mean(axis=1)
    return np.mean(batches), np.std(batches, ddof=1) / math.sqrt(BATCHES)


def _grows(growth, mean, error):
    lasting = np.mean(growth[-len(growth) // 4 :]) > mean / 2
    return lasting and mean > CONFIDENCE * error and np.sum(growth) > GROWN


def _on_orbit(p, record, states, contacts, limit):
    last, components = states[-1], 2 if contacts == 0 else 3
    before = states[-2 : -2 - LONGEST : -1]
    near = np.max(np.abs(before - last)[:, :components], axis=1) < NEAR
    for n in np.flatnonzero(near) + 1:
        y, n = last.copy(), int(n)
        found, residual, multiplier = polish(p, y, n, REACH, POLISH_TOLERANCE)
        if not found or abs(multiplier) >= 1:
            continue
        duration = n * 2 * math.pi / p[FREQUENCY]
        record["state"], record["period"], record["residual"] = y, n, residual
        record["multiplier"], record["lyapunov_error"] = multiplier, 0.0
        record["lyapunov_exponent"] = math.log(abs(multiplier)) / duration
        if contacts > 0 or p[CLEARANCE] == math.inf:
            return records.SETTLED
        drift = abs(y[3] - y[1]) * limit * 2 * math.pi / p[FREQUENCY]
        return records.NON_COLLIDING if drift < 0.01 * p[CLEARANCE] else records.DRIFTING
    return records.UNRESOLVED


def _quasi_periodic(p, record, states, mean, error):
    if abs(mean) > NEUTRAL * error:
        return records.UNRESOLVED
    # `find_rotation` fails on a curve that has corners because of contacts, or that does not go
    # around its centre. So curves in two planes are tried, and the most accurate result is taken.
    planes = [states[:, k] + 1j * states[:, k + 1] / p[FREQUENCY] for k in (0, 2)]
    for curves in range(1, LONGEST_PERIOD + 1):
        parts = [points[first::curves] for points in planes for first in range(curves)]
        rotations = [found for found in map(find_rotation, parts) if found is not None]
        if rotations:
            number, error = min(rotations, key=lambda rotation: rotation[1])
            first = p[FREQUENCY] / curves
            record["first_frequency"], record["second_frequency"] = first, first * number
            record["frequency_error"] = first * error
            return records.QUASI_PERIODIC if error <= AGREEMENT else records.UNRESOLVED
    return records.UNRESOLVED


def birkhoff_average(values):
    """Return the mean of values with the weights exp(-1/(t (1 - t))); t rises from 0 to 1."""
    t = np.arange(1, len(values) + 1) / (len(values) + 1)
    weights = np.exp(-1 / (t * (1 - t)))
    return np.sum(weights * values) / np.sum(weights)


def find_rotation(points):
    """Return the rotation number of points (complex numbers) on a closed curve, and its error.

    From each point to the next, the angle around the centre of the curve advances. The rotation
    number, from 0 to 1/2, is the mean advance in revolutions. First the curve is stretched until
    its spread is equal in all directions, because on a slender curve the angle advances mainly at
    both tips. The number is also computed from each of three parts of the points. The error is the
    largest of these three numbers minus the smallest. Return None if no closed curve is recognised.
    """
    if len(points) < FEWEST:
        return None
    angle = np.angle(_rounded(points)) / (2 * math.pi)
    advance = np.diff(angle) % 1
    order = np.sort(advance)
    intervals = np.diff(order, append=order[0] + 1)
    widest = np.argmax(intervals)
    if intervals[widest] < INTERVAL:
        return None
    cut = order[widest] + intervals[widest] / 2
    advance = (advance - cut) % 1 + cut
    number = birkhoff_average(advance)
    if not _goes_around_once(angle, number):
        return None
    half, quarter = len(advance) // 2, len(advance) // 4
    parts = [birkhoff_average(advance[k : k + half]) for k in (0, quarter, len(advance) - half)]
    return min(number % 1, -number % 1), np.ptp(parts)


def _rounded(points):
    apart = points - birkhoff_average(points)
    plane = np.stack([apart.real, apart.imag])
    spread, axes = np.linalg.eigh(plane @ plane.T)
    x, y = axes.T @ plane
    return x * math.sqrt(max(spread[1], 0.0)) + 1j * y * math.sqrt(max(spread[0], 0.0))


def _goes_around_once(angle, number):
    order = np.argsort(np.arange(len(angle)) * number % 1)
    turns = np.diff(angle[order], append=angle[order[0]])
    turns -= np.round(turns)
    once = abs(round(np.sum(turns))) == 1
    return bool(once and np.max(np.abs(turns)) < TURN and np.sum(np.abs(turns)) < WANDERING)
