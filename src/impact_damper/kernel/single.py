"""The event-driven flow of one trajectory, in steps that end at events.

A state is (Z1, Z1', Z2, Z2'), together with `side`, the wall that the loose mass touches: -1 or 1,
or 0 in flight. Solutions of the variational equations, the tangents, are integrated with the
trajectory if they are given.
"""

import numpy as np

from impact_damper.kernel import instances
from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.equation import has_escaped, no_return
from impact_damper.kernel.memory import CACHE_LINE, aligned, pointer
from impact_damper.kernel.series import rows
from impact_damper.system import packed
from impact_damper.system.packed import CLEARANCE

_ONE = instances.instance(1)
kept_series = _ONE.kept_series
flight_step, contact_step, flight_tangents, contact_tangents = instances.bound_steps(_ONE)
SIZE, TANGENT_SIZE, COLUMNS = _ONE.SIZE, _ONE.TANGENT_SIZE, _ONE.TANGENTS
# Index in a workspace at which the numbers of the tangents begin; a multiple of a cache line.
BEHIND = -(-SIZE // CACHE_LINE) * CACHE_LINE
SIDE, TIME, LONGEST, TOLERANCE, LENGTH = (
    _ONE.SIDE,
    _ONE.TIME,
    _ONE.LONGEST,
    _ONE.TOLERANCE,
    _ONE.LENGTH,
)
PARAMETERS, STATE, KNOWN, X, Q = _ONE.FREQUENCY, _ONE.Y0, _ONE.KNOWN, _ONE.X, _ONE.Q
FLIGHT_ORDER, CONTACT_ORDER = _ONE.FLIGHT_ORDER, _ONE.CONTACT_ORDER
# Indices in a workspace of the series of tangents: COLUMNS numbers for each coefficient.
_ROWS = rows(FLIGHT_ORDER, CONTACT_ORDER)
DX, DQ = (BEHIND + _ROWS[name] * COLUMNS for name in ("DX", "DQ"))


@kernel
def workspace():
    """Return an array for the rows of one trajectory and of its tangents (`series.rows`)."""
    return aligned(BEHIND + TANGENT_SIZE)


@kernel
def assign(target, state):
    """Copy a state of four numbers; numba takes three seconds to compile `target[:] = state`."""
    for i in range(4):
        target[i] = state[i]


@kernel
def polynomial(c, order, t):
    """Return value and first derivative at t of a polynomial with coefficients c."""
    value = c[order]
    slope = 0.0
    for k in range(order - 1, -1, -1):
        slope = slope * t + value
        value = value * t + c[k]
    return value, slope


@kernel_only
def write_trajectory(p, y, side, tolerance, a):
    """Write parameters and state of a trajectory into the rows of a workspace.

    These rows are the same for all orders of the series.
    """
    for i in range(packed.COUNT):
        a[PARAMETERS + i] = p[i]
    for i in range(4):
        a[STATE + i] = y[i]
    a[SIDE] = side
    a[TOLERANCE] = tolerance
    a[KNOWN] = np.inf


@kernel
def load(p, y, tangents, side, tolerance, a, d):
    """Write a trajectory and its tangents into a workspace, and fill its kept series."""
    write_trajectory(p, y, side, tolerance, a)
    kept_series(a)
    if len(tangents) > 0:
        for i in range(COLUMNS):
            for j in range(4):
                d[COLUMNS * j + i] = tangents[i, j] if i < len(tangents) else 0.0


@kernel_only
def unload(y, tangents, a, d):
    """Read the state and the tangents from a workspace."""
    for i in range(4):
        y[i] = a[STATE + i]
    for i in range(len(tangents)):
        for j in range(4):
            tangents[i, j] = d[COLUMNS * j + i]


@kernel_only
def step_loaded(count, t, longest, a, d):
    """Do `step` for a trajectory and `count` tangents that are in the workspace already."""
    a[TIME] = t
    a[LONGEST] = longest
    if a[SIDE] == 0.0:
        flight_step(a)
        if count > 0:
            flight_tangents(a, d)
    else:
        contact_step(a)
        if count > 0:
            contact_tangents(a, d)
    return a[LENGTH], np.int64(a[SIDE])


@kernel
def step(p, y, tangents, side, t, longest, tolerance, work):
    """One step of the flow, ended early by an event.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters (`packed.pack`).
    y : array, shape (4,)
        Z1, Z1', Z2, Z2'; replaced.
    tangents : array, shape (m, 4)
        Solutions of the variational equations, m from 0 to 4; replaced.
    side : int
        Wall in contact, -1 or 1, or 0 in flight.
    t, longest, tolerance : float
        Time (only the phase of the forcing depends on it), longest step, local error allowed.
    work : array
        `workspace()`. Afterwards it holds from X on the series of Z1 over the step and, after a
        step in contact, from Q on that of Z2 -+ d0.

    Returns
    -------
    length : float
        Time by which the state has advanced. It is `longest` once the motion has escaped
        (`equation.no_return`), since steps on the way to infinity would become ever shorter. The
        returned state is then the state at the escape, after the time `work[LENGTH]`.
    side : int
        Wall in contact after the step.
    """
    a, d = pointer(work), pointer(work[BEHIND:])
    load(p, y, tangents, side, tolerance, a, d)
    length, side = step_loaded(len(tangents), t, longest, a, d)
    unload(y, tangents, a, d)
    return (longest if has_escaped(p, y[0], y[1]) else length), side


@kernel
def side_of(p, y):
    """Return the wall in contact in a state, -1 or 1, or 0 in flight.

    A mass on a wall is in contact if it moves outward.
    """
    if y[2] > p[CLEARANCE] or (y[2] == p[CLEARANCE] and y[3] > 0.0):
        return 1
    if y[2] < -p[CLEARANCE] or (y[2] == -p[CLEARANCE] and y[3] < 0.0):
        return -1
    return 0


@kernel
def advance(p, y, tangents, side, t, end, tolerance, work):
    """Integrate from t to end; return the side then, contacts begun and time in contact.

    A motion that escapes (`equation.no_return`) is left in its state at the escape.
    """
    contacts = 0
    touching = 0.0
    farthest = no_return(p)
    a, d = pointer(work), pointer(work[BEHIND:])
    load(p, y, tangents, side, tolerance, a, d)
    while t < end:
        before = side
        length, side = step_loaded(len(tangents), t, end - t, a, d)
        escaped = not (abs(a[STATE]) <= farthest or a[STATE] * a[STATE + 1] <= 0.0)
        t = end if escaped or length >= end - t else t + length
        if before == 0 and side != 0:
            contacts += 1
        if before != 0:
            touching += length
    unload(y, tangents, a, d)
    return side, contacts, touching
