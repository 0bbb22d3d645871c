"""Run undecided motions longer, until their outcome is certain.

A run that does not settle to an orbit and is not certainly chaotic may be quasi-periodic, may be
periodic with a long period, may approach an orbit slowly, may be weakly chaotic, or may have a
loose mass that drifts in the gap. This module continues such a run in blocks, each twice as long as
the block before, until one of these outcomes is certain.

Z1 is the displacement of the primary mass, and Z2 its displacement relative to the loose mass. A
strobe is the time of the forcing phase pi/2 in each cycle.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.equation import forcing_amplitude, has_escaped
from impact_damper.kernel.single import side_of, workspace
from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.motions.records import (
    CHAOTIC,
    DIVERGED,
    DRIFTING,
    ESCAPED,
    NON_COLLIDING,
    QUASI_PERIODIC,
    SETTLED,
    UNRESOLVED,
)
from impact_damper.motions.rotation_numbers import find_rotation
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, one_period, polish
from impact_damper.motions.watch import CONFIDENCE, LONGEST_PERIOD, NEAR

# Largest number of forcing cycles of the first block.
FIRST = 1500
# Smallest growth of the tangent of a chaotic motion in a block, as a natural logarithm. The tangent
# also grows while a motion leaves an unstable orbit. The distance from the orbit then grows from a
# rounding error of 1e-16 to a size of order 1, and the tangent grows as much, by ln(1e16) = 37.
GROWN = 40.0
# Number of batches of a block, from which the standard error of the exponent is computed.
BATCHES = 30
# An exponent counts as 0 if it is within NEUTRAL standard errors of 0.
NEUTRAL = 3.0
# Longest period of an orbit, in forcing cycles.
LONGEST = 256
# Largest distance that Newton's method may move a state onto an orbit.
REACH = 1e-2
# A motion lies on known closed curves if its distance from them is below NEIGHBOUR.
NEIGHBOUR = 1e-3
# If a motion lies on known closed curves, these fields are copied from the record of the known
# motion.
TORUS = (
    "outcome",
    "lyapunov_exponent",
    "lyapunov_error",
    "first_frequency",
    "second_frequency",
    "frequency_error",
)


@kernel
def run_block(p, y, tangent, states, growth, stop):
    """Run a motion in place over the forcing cycles of a block.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
    y : array, shape (4,)
        State at the strobe, replaced by the last state.
    tangent : array, shape (1, 4)
        Solution of the variational equations, also replaced. It is scaled to length 1 after each
        cycle.
    states : array, shape (n, 4)
        Receives the state after each cycle.
    growth : array, shape (n,)
        Receives the logarithm of the growth of the tangent in each cycle.
    stop : array of bool, shape (1,)
        Another thread may set this flag to end the run.

    Returns
    -------
    contacts : int
        Number of contacts.
    escaped : bool
        Whether the motion escaped.
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
        size = 0.0
        for i in range(4):
            states[k, i] = y[i]
            size += tangent[0, i] ** 2
        size = math.sqrt(size)
        for i in range(4):
            tangent[0, i] /= size
        growth[k] = math.log(size)
    return total, False


def name_undecided(parameters, records, limit, further, stop):
    """Continue the unresolved motions of `records`, and complete their records in place.

    Parameters
    ----------
    parameters : array, shape (m, packed.COUNT)
    records : array of records.MOTION, shape (m,)
        Filled by `settling.settle_many`.
    limit : int
        Forcing cycles of the run before. The first block has the same length, but at most FIRST.
    further : int
        Largest number of forcing cycles of all blocks together.
    stop : array of bool, shape (1,)
        Another thread may set this flag to end the runs. The records are then incomplete.
    """
    curves = []
    for i in np.flatnonzero(records["outcome"] == UNRESOLVED):
        p, record = parameters[i], records[i : i + 1]
        if forcing_amplitude.py_func(p) > 0:
            known = [curve for curve in curves if np.array_equal(curve.parameters, p)]
            states = _name_one(p, record, limit, further, known, stop)
            if record["outcome"] == QUASI_PERIODIC:
                curves.append(_Curves(p, states, record.copy()))


class _Curves(NamedTuple):
    """Closed curves on which a quasi-periodic motion lies at the strobe, represented by states."""

    parameters: np.ndarray
    states: np.ndarray
    record: np.ndarray


def _name_one(p, record, limit, further, known, stop):
    """Continue one motion, whose record is an array of length 1, until its outcome is certain.

    A motion that reaches known closed curves is the same motion as the known one. Return the states
    of the last block.
    """
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
            record["outcome"] = ESCAPED if escaped else DIVERGED
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
            or (CHAOTIC if _grows(growth, mean, error) else UNRESOLVED)
        )
        if record["outcome"] != UNRESOLVED:
            break
        further, count = further - count, 2 * count
    return states


def _is_known(record, known, states):
    """Return whether states lie on known curves (NEIGHBOUR). If they do, complete the record."""
    for curves in known:
        apart = np.abs(states[:, None, :3] - curves.states[None, :, :3]).max(axis=2)
        if np.max(np.min(apart, axis=1)) < NEIGHBOUR:
            for name in TORUS:
                record[name] = curves.record[name]
            return True
    return False


def _exponent(growth):
    """Return the mean growth (logarithm) in a cycle and its standard error, from BATCHES batches.

    On a closed curve growth and decay alternate, and cancel only in long batches.
    """
    length = len(growth) // BATCHES
    batches = growth[-BATCHES * length :].reshape(BATCHES, length).mean(axis=1)
    return np.mean(batches), np.std(batches, ddof=1) / math.sqrt(BATCHES)


def _grows(growth, mean, error):
    """Return whether a tangent certainly grows in a block, and still grows in its last quarter.

    In the last quarter the growth in a cycle must exceed half the mean growth of the block.
    """
    lasting = np.mean(growth[-len(growth) // 4 :]) > mean / 2
    return lasting and mean > CONFIDENCE * error and np.sum(growth) > GROWN


def _on_orbit(p, record, states, contacts, limit):
    """Move a motion onto the stable orbit near it and return its outcome; else UNRESOLVED.

    If the loose mass has touched no wall, only the primary mass must be on an orbit.
    """
    last, components = states[-1], 2 if contacts == 0 else 3
    before = states[-2 : -2 - LONGEST : -1]
    near = np.max(np.abs(before - last)[:, :components], axis=1) < NEAR
    for n in np.flatnonzero(near) + 1:
        y, n = last.copy(), int(n)
        found, residual, multiplier = polish(p, y, n, REACH, POLISH_TOLERANCE)
        # n rises, so the first orbit found has the shortest period; divisors need no check.
        if not found or abs(multiplier) >= 1:
            continue
        duration = n * 2 * math.pi / p[FREQUENCY]
        record["state"], record["period"], record["residual"] = y, n, residual
        record["multiplier"], record["lyapunov_error"] = multiplier, 0.0
        record["lyapunov_exponent"] = math.log(abs(multiplier)) / duration
        if contacts > 0 or p[CLEARANCE] == math.inf:
            return SETTLED
        drift = abs(y[3] - y[1]) * limit * 2 * math.pi / p[FREQUENCY]
        return NON_COLLIDING if drift < 0.01 * p[CLEARANCE] else DRIFTING
    return UNRESOLVED


def _quasi_periodic(p, record, states, mean, error):
    """Return QUASI_PERIODIC if the states move along closed curves, otherwise UNRESOLVED.

    For each number of curves up to LONGEST_PERIOD, `find_rotation` is tried on every curve, because
    it can fail on a curve with corners. A curve has corners if contacts begin or end at the strobe.
    It is tried in the plane of (Z1, Z1') and in the plane of (Z2, Z2'), because in one of these
    planes the curve may be so bent that it does not go around its centre.
    """
    if abs(mean) > NEUTRAL * error:
        return UNRESOLVED
    planes = [states[:, k] + 1j * states[:, k + 1] / p[FREQUENCY] for k in (0, 2)]
    for curves in range(1, LONGEST_PERIOD + 1):
        rotations = [
            find_rotation(points[first::curves]) for points in planes for first in range(curves)
        ]
        rotations = [rotation for rotation in rotations if rotation is not None]
        if rotations:
            best = min(rotations, key=lambda rotation: rotation.error)
            first = p[FREQUENCY] / curves
            record["first_frequency"], record["second_frequency"] = first, first * best.number
            record["frequency_error"] = first * best.error
            return QUASI_PERIODIC if best.known else UNRESOLVED
    return UNRESOLVED
