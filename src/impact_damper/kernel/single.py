"""Integrate one trajectory in steps. An event, such as the beginning of a contact, ends a step.

The state is (Z1, Z1', Z2, Z2'). `side` is the wall in contact, -1 or 1, or 0 in flight.
"""

import numpy as np

from impact_damper.kernel import instances
from impact_damper.kernel.compiling import (
    CACHE_LINE,
    aligned,
    by_address,
    kernel,
    kernel_only,
    pointer,
)
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.instances import rows
from impact_damper.model import packed
from impact_damper.model.packed import CLEARANCE, DAMPING, DASHPOT, FREQUENCY, LAG

_ONE = instances.instance(1)
constant_series, find_sway = _ONE.constant_series, _ONE.find_sway
flight_step, contact_step = by_address(_ONE.flight_step), by_address(_ONE.contact_step)
SIZE, TANGENT_SIZE, COLUMNS = _ONE.SIZE, _ONE.TANGENT_SIZE, _ONE.TANGENTS
# Index in a workspace at which the numbers of the tangents begin. It is a multiple of CACHE_LINE.
BEHIND = -(-SIZE // CACHE_LINE) * CACHE_LINE
SIDE, TIME, LONGEST = _ONE.SIDE, _ONE.TIME, _ONE.LONGEST
TOLERANCE, LENGTH = _ONE.TOLERANCE, _ONE.LENGTH
PARAMETERS, STATE, KNOWN, X, Q = _ONE.FREQUENCY, _ONE.Y0, _ONE.KNOWN, _ONE.X, _ONE.Q
T, SWAY, SWAY_SLOPE, STUCK = _ONE.T, _ONE.SWAY, _ONE.SWAY_SLOPE, _ONE.STUCK
DRAW, BASE_COSINE, BASE_SINE, E = _ONE.DRAW, _ONE.BASE_COSINE, _ONE.BASE_SINE, _ONE.E
FLIGHT_ORDER, CONTACT_ORDER = _ONE.FLIGHT_ORDER, _ONE.CONTACT_ORDER
# In a workspace the Taylor coefficients of each tangent's Z1 begin at the index DX. The
# coefficients of the depth begin at DQ. Each order has COLUMNS numbers, one for each tangent.
_ROWS = rows(FLIGHT_ORDER, CONTACT_ORDER)
DX, DQ = (BEHIND + _ROWS[name] * COLUMNS for name in ("DX", "DQ"))

# `extremum` divides an interval into PIECES pieces, and looks for one maximum in each piece.
PIECES = 8


@kernel
def workspace():
    """Return an array with room for all numbers of a step of one trajectory and its tangents."""
    return aligned(BEHIND + TANGENT_SIZE)


@kernel
def assign(target, state):
    """Copy a state into `target`. numba would need three seconds to compile `target[:] = state`."""
    for i in range(4):
        target[i] = state[i]


@kernel
def polynomial(c, order, t):
    """Return the polynomial c[0] + c[1] t + ... + c[order] t^order and its derivative at t."""
    value = c[order]
    slope = 0.0
    for k in range(order - 1, -1, -1):
        slope = slope * t + value
        value = value * t + c[k]
    return value, slope


@kernel
def extremum(c, order, length, start):
    """Return the larger of `start` and the largest |c[0] + c[1] t + ...| for t in [0, `length`]."""
    farthest = 0.0
    for k in range(order, 0, -1):
        farthest = (farthest + abs(c[k])) * length
    if farthest + abs(c[0]) <= start:
        return start
    low, fall = polynomial(c, order, 0.0)
    high, _ = polynomial(c, order, length)
    excess, power = 0.0, length
    for k in range(2, order + 1):
        power *= length
        excess += 0.125 * k * (k - 1) * abs(c[k]) * power
    best = max(start, max(abs(low), abs(high)))
    if max(abs(low), abs(high)) + excess <= best:
        return best
    for piece in range(1, PIECES + 1):
        t = length * piece / PIECES
        value, slope = polynomial(c, order, t)
        best = max(best, abs(value))
        # The modulus has a maximum in a piece if it grows at the beginning and falls at the end.
        if slope * fall < 0.0 and value * slope < 0.0:
            turn = turning_time(c, order, t - length / PIECES, t, fall, slope)
            best = max(best, abs(polynomial(c, order, turn)[0]))
        fall = slope
    return best


@kernel_only
def turning_time(c, order, begin, end, first, last):
    """Return the time, between `begin` and `end`, at which the slope of a polynomial is 0.

    The polynomial is c[0] + c[1] t + ... + c[order] t^order. Its slope is `first` at `begin` and
    `last` at `end`. The signs of both slopes differ.
    """
    t = begin + (end - begin) * first / (first - last)
    for _ in range(4):
        _, slope = polynomial(c, order, t)
        bend = 0.0
        for k in range(order, 1, -1):
            bend = bend * t + k * (k - 1) * c[k]
        if bend == 0.0:
            break
        t = min(max(t - slope / bend, begin), end)
    return t


@kernel_only
def write_trajectory(p, y, side, tolerance, a):
    """Write the parameters, state, `side` and tolerance of a trajectory into a workspace."""
    for i in range(packed.COUNT):
        a[PARAMETERS + i] = p[i]
    for i in range(4):
        a[STATE + i] = y[i]
    a[SIDE] = side
    a[TOLERANCE] = tolerance
    a[KNOWN] = np.inf


@kernel_only
def load(p, y, side, tolerance, a):
    """Write a trajectory into a workspace. Update the Taylor series that depend on p alone."""
    kept = True
    for i in (FREQUENCY, DAMPING, DASHPOT):
        kept = kept and a[PARAMETERS + i] == p[i]
    write_trajectory(p, y, side, tolerance, a)
    if not kept:
        constant_series(a)


@kernel_only
def step_loaded(t, longest, a):
    """Do a step from the time t. Return its length, at most `longest`, and the side at its end."""
    a[TIME] = t
    a[LONGEST] = longest
    if a[SIDE] == 0.0:
        flight_step(a)
    else:
        contact_step(a)
    return a[LENGTH], np.int64(a[SIDE])


@kernel_only
def unload(y, a):
    """Copy the state that is in the workspace a to y."""
    for i in range(4):
        y[i] = a[STATE + i]


@kernel
def step(p, y, side, t, longest, tolerance, work):
    """Integrate one step, at most up to the first event and at most over the time `longest`.

    The step begins at the time t in the state y (4,). The state at the end replaces y. Return the
    step's length, and the side at its end. `work` is a `workspace()`. After the step `work` has
    the Taylor coefficients of Z1 from index X on, and after a step in contact the coefficients
    of the depth Z2 - `side` d0 from index Q on. If the motion has escaped (`equation.no_return`),
    the returned length is `longest`, and `work[LENGTH]` is the true length.
    """
    a = pointer(work)
    load(p, y, side, tolerance, a)
    length, side = step_loaded(t, longest, a)
    unload(y, a)
    return (longest if has_escaped(p, y[0], y[1]) else length), side


@kernel_only
def state_in_step(work, side, y, t):
    """Return the state at time t of the last step in `work`. The step began at t = 0 in state y."""
    a = pointer(work)
    order = FLIGHT_ORDER if side == 0 else CONTACT_ORDER
    x, v = polynomial(work[X:], order, t)
    if side == 0:
        a[T] = t
        find_sway(a)
        z = x + (y[2] - y[0]) + (y[3] - y[1]) * t + a[SWAY]
        w = v + (y[3] - y[1]) + a[SWAY_SLOPE]
    else:
        q, w = polynomial(work[Q:], order, t)
        z = side * a[PARAMETERS + CLEARANCE] + q
    if a[STUCK] > 0.0:
        return x, v, y[2], 0.0
    return x, v, z, w


@kernel_only
def series_of_loose_mass(work, side, y, c):
    """After a step from state y, fill c with the step's Taylor series of Z2. Return its order."""
    a = pointer(work)
    order = FLIGHT_ORDER if side == 0 else CONTACT_ORDER
    for k in range(order + 1):
        c[k] = a[X + k] if side == 0 else a[Q + k]
    if side != 0:
        c[0] += side * a[PARAMETERS + CLEARANCE]
    else:
        c[0] += y[2] - y[0]
        c[1] += y[3] - y[1]
        for k in range(order - 1):
            moved = a[E + k] * (a[BASE_SINE] if k % 2 else a[BASE_COSINE])
            c[k + 2] += ((a[DRAW] if k == 0 else 0.0) - moved) / ((k + 1) * (k + 2))
    if a[STUCK] > 0.0:
        c[0] = y[2]
        for k in range(1, order + 1):
            c[k] = 0.0
    return order


@kernel
def side_of(p, y):
    """Return the wall that the loose mass presses in the state y: -1 or 1, or 0 in flight."""
    wall = 1 if y[2] > 0.0 else -1
    depth = abs(y[2]) - p[CLEARANCE]
    if depth < 0.0 or (p[LAG] > 0.0 and depth + p[LAG] * wall * y[3] <= 0.0):
        return 0
    return wall if depth > 0.0 or wall * y[3] > 0.0 else 0
