"""Integrate one trajectory and its tangents. A tangent is a solution of the variational equations.

An import of this module compiles the kernels of the tangents (`compiling.by_address`). Therefore a
module that integrates no tangents imports `single` instead of this module.
"""

from impact_damper.kernel import instances
from impact_damper.kernel.compiling import by_address, kernel, kernel_only, pointer
from impact_damper.kernel.equation import has_escaped, no_return
from impact_damper.kernel.single import BEHIND, COLUMNS, SIDE, STATE, load, step_loaded, unload

_ONE = instances.instance(1)
flight_tangents = by_address(_ONE.flight_tangents)
contact_tangents = by_address(_ONE.contact_tangents)


@kernel_only
def load_tangents(tangents, d):
    """Write tangents, shape (m, 4), into d, the part of a workspace for tangents."""
    if len(tangents) > 0:
        for i in range(COLUMNS):
            for j in range(4):
                d[COLUMNS * j + i] = tangents[i, j] if i < len(tangents) else 0.0


@kernel_only
def unload_tangents(tangents, d):
    """Copy tangents, shape (m, 4), from d, the part of a workspace for tangents."""
    for i in range(len(tangents)):
        for j in range(4):
            tangents[i, j] = d[COLUMNS * j + i]


@kernel_only
def step_all(count, t, longest, a, d):
    """Step a trajectory and `count` tangents. Return the step's length, and the side at its end."""
    before = a[SIDE]
    length, side = step_loaded(t, longest, a)
    if count > 0:
        if before == 0.0:
            flight_tangents(a, d)
        else:
            contact_tangents(a, d)
    return length, side


@kernel
def step_with_tangents(p, y, tangents, side, t, longest, tolerance, work):
    """Do a step as `single.step` does. The new tangents replace `tangents`, (m, 4) with m <= 4."""
    a, d = pointer(work), pointer(work[BEHIND:])
    load(p, y, side, tolerance, a)
    load_tangents(tangents, d)
    length, side = step_all(len(tangents), t, longest, a, d)
    unload(y, a)
    unload_tangents(tangents, d)
    return (longest if has_escaped(p, y[0], y[1]) else length), side


@kernel
def advance(p, y, tangents, side, t, end, tolerance, work):
    """Integrate a trajectory and its tangents from the time t to the time `end`.

    The final state and tangents replace y and `tangents`. Return the side at the end, the number of
    contacts that began, and the total time in contact. An escape ends the integration early.
    """
    contacts = 0
    touching = 0.0
    farthest = no_return(p)
    a, d = pointer(work), pointer(work[BEHIND:])
    load(p, y, side, tolerance, a)
    load_tangents(tangents, d)
    while t < end:
        before = side
        length, side = step_all(len(tangents), t, end - t, a, d)
        escaped = not (abs(a[STATE]) <= farthest or a[STATE] * a[STATE + 1] <= 0.0)
        t = end if escaped or length >= end - t else t + length
        if before == 0 and side != 0:
            contacts += 1
        if before != 0:
            touching += length
    unload(y, a)
    unload_tangents(tangents, d)
    return side, contacts, touching
