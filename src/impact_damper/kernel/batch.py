"""Integrate many trajectories. One step advances LANES trajectories together, one in each lane.

All trajectories of one step must be in flight, or all must be in contact. Therefore a pool holds
more trajectories than there are lanes, and has a queue for each kind of step: flight or contact,
with a tangent or without. Each step takes trajectories from the longest queue.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.kernel import instances
from impact_damper.kernel.compiling import aligned, by_address, kernel, kernel_only, pointer
from impact_damper.kernel.equation import no_return
from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER
from impact_damper.kernel.single import extremum
from impact_damper.model import packed

LANES = 16
# Largest number of trajectories in a pool. With 64 the longest queue fills all lanes in most steps.
RESIDENT = 64
FLIGHT, CONTACT, FLIGHT_WITH_TANGENT, CONTACT_WITH_TANGENT = range(4)

_MANY = instances.instance(LANES)
flight_step, contact_step = by_address(_MANY.flight_step), by_address(_MANY.contact_step)
flight_tangents = by_address(_MANY.flight_tangents)
contact_tangents = by_address(_MANY.contact_tangents)
SIZE, TANGENT_SIZE = _MANY.SIZE, _MANY.TANGENT_SIZE
# Columns of `Pool.numbers`. Column j has the numbers that belong in row j of the array of a step.
# In this array row j begins at the index j * LANES.
STATE, SIDE, TIME, LONGEST, TOLERANCE, LENGTH = (
    row // LANES
    for row in (_MANY.Y0, _MANY.SIDE, _MANY.TIME, _MANY.LONGEST, _MANY.TOLERANCE, _MANY.LENGTH)
)


class Pool(NamedTuple):
    """A pool of n trajectories. Each trajectory has its own end time.

    numbers: A row for each trajectory: parameters, state, SIDE, TIME, LONGEST and TOLERANCE.
    ends: Times at which the integration of the trajectories ends; shape (n,).
    farthest: |Z1| beyond which a trajectory escapes (`equation.no_return`); shape (n,).
    tangents: A solution of the variational equations for each trajectory; shape (n, 4).
    queues: Indices of the waiting trajectories, a row for each kind of step; shape (4, n).
    waiting: Number of trajectories in each queue; shape (4,).
    contacts: Number of contacts begun since the last call of `send`; shape (n,).
    largest: Largest |Z1| so far. NaN, set by `enter`, means that it is not computed; shape (n,).
    held: For each lane the index of the trajectory whose parameters it has, or -1; shape (LANES,).
    a, d: Arrays for a step of LANES trajectories (a) and for their tangents (d).
    """

    numbers: np.ndarray
    ends: np.ndarray
    farthest: np.ndarray
    tangents: np.ndarray
    queues: np.ndarray
    waiting: np.ndarray
    contacts: np.ndarray
    largest: np.ndarray
    held: np.ndarray
    a: np.ndarray
    d: np.ndarray


@kernel
def make_pool(size):
    """Return a pool with room for `size` trajectories."""
    return Pool(
        np.zeros((size, LENGTH)),
        np.zeros(size),
        np.zeros(size),
        np.zeros((size, 4)),
        np.zeros((4, size), np.int64),
        np.zeros(4, np.int64),
        np.zeros(size, np.int64),
        np.full(size, np.nan),
        np.full(LANES, -1),
        aligned(SIZE),
        aligned(TANGENT_SIZE),
    )


@kernel
def enter(pool, m, p, y, side, tolerance):
    """Store a trajectory, with packed parameters p and state y, at index m of a pool."""
    numbers = pool.numbers[m]
    for i in range(packed.COUNT):
        numbers[i] = p[i]
    for i in range(4):
        numbers[STATE + i] = y[i]
    numbers[SIDE] = side
    numbers[TOLERANCE] = tolerance
    pool.farthest[m] = no_return(p)
    pool.largest[m] = np.nan
    for lane in range(LANES):
        if pool.held[lane] == m:
            pool.held[lane] = -1


@kernel
def send(pool, m, t, end, with_tangent):
    """Put trajectory m into a queue, to be integrated from time t to time `end`."""
    pool.numbers[m, TIME] = t
    pool.ends[m] = end
    pool.contacts[m] = 0
    phase = CONTACT if pool.numbers[m, SIDE] != 0.0 else FLIGHT
    enqueue(pool.queues, pool.waiting, m, phase + (FLIGHT_WITH_TANGENT if with_tangent else 0))


@kernel_only
def enqueue(queues, waiting, m, kind):
    """Append trajectory m to the queue for steps of the given kind."""
    queues[kind, waiting[kind]] = m
    waiting[kind] += 1


@kernel
def choose(pool, chosen):
    """Take up to LANES trajectories from the longest queue. Put their indices into `chosen`.

    Return how many trajectories were taken, and the kind of their next step. If fewer than LANES
    trajectories were taken, the last index is repeated until `chosen` is full.
    """
    waiting = pool.waiting
    kind = FLIGHT
    for other in range(1, 4):
        if waiting[other] > waiting[kind]:
            kind = other
    count = min(waiting[kind], LANES)
    waiting[kind] -= count
    for lane in range(LANES):
        chosen[lane] = pool.queues[kind, waiting[kind] + min(lane, count - 1)]
    return count, kind


@kernel_only
def gather(pool, chosen, kind):
    """Copy trajectories from the pool into the lanes.

    `chosen` has the index of a trajectory for each lane. Parameters are not copied again if the
    lane still has them. Tangents are copied if steps of this `kind` have tangents.
    """
    for lane in range(LANES):
        m = chosen[lane]
        numbers = pool.numbers[m]
        numbers[LONGEST] = pool.ends[m] - numbers[TIME]
        if pool.held[lane] != m:
            pool.held[lane] = m
            for row in range(STATE):
                pool.a[row * LANES + lane] = numbers[row]
        for row in range(STATE, LENGTH):
            pool.a[row * LANES + lane] = numbers[row]
        if kind >= FLIGHT_WITH_TANGENT:
            for row in range(4):
                pool.d[row * LANES + lane] = pool.tangents[m, row]


@kernel_only
def scatter(pool, chosen, count, kind, arrived):
    """Copy trajectories from the lanes back into the pool. Queue unfinished trajectories again.

    `chosen` has the index of the trajectory in each lane. The lanes from `count` on only repeat a
    trajectory, and are not copied. Tangents are copied if steps of this `kind` have tangents.
    Return how many trajectories have ended. `arrived` receives the indices of these trajectories.
    A trajectory ends at its end time, or before, if it escapes (`equation.no_return`).
    """
    ended = 0
    for lane in range(count):
        m = chosen[lane]
        numbers = pool.numbers[m]
        for row in range(STATE, SIDE + 1):
            numbers[row] = pool.a[row * LANES + lane]
        if kind >= FLIGHT_WITH_TANGENT:
            for row in range(4):
                pool.tangents[m, row] = pool.d[row * LANES + lane]
        touching = numbers[SIDE] != 0.0
        if touching and kind & 1 == FLIGHT:
            pool.contacts[m] += 1
        length = pool.a[LENGTH * LANES + lane]
        x, v = numbers[STATE], numbers[STATE + 1]
        gone = not (abs(x) <= pool.farthest[m] or x * v <= 0.0)
        if gone:
            pool.largest[m] = np.inf
        if length >= numbers[LONGEST] or gone:
            numbers[TIME] = pool.ends[m]
            arrived[ended] = m
            ended += 1
        else:
            numbers[TIME] += length
            phase = CONTACT if touching else FLIGHT
            enqueue(pool.queues, pool.waiting, m, (kind & FLIGHT_WITH_TANGENT) + phase)
    return ended


@kernel_only
def raise_largest(pool, chosen, count, kind):
    """After a step, update `pool.largest`, the largest |Z1| of each chosen trajectory.

    The largest |Z1| in the step is computed only if an upper bound on it exceeds `pool.largest`.
    The bound is `ends` + `rise`. `ends` is the larger of |Z1| at the beginning and |Z1| at the end.
    In contact `rise` is the sum of |x[k]| t^k over k >= 1, with Taylor coefficients x[k] of Z1 and
    the step's length t. In flight `rise` follows from CHANGE, a bound on the change of Z1'.
    """
    a, order = pool.a, CONTACT_ORDER if kind & 1 else FLIGHT_ORDER
    rise, series = np.zeros(LANES), np.empty(max(FLIGHT_ORDER, CONTACT_ORDER) + 1)
    for k in range(order if kind & 1 else 0, 0, -1):
        for lane in range(LANES):
            term = abs(a[_MANY.X + k * LANES + lane])
            rise[lane] = (rise[lane] + term) * a[LENGTH * LANES + lane]
    for lane in range(count):
        m, length = chosen[lane], a[LENGTH * LANES + lane]
        if kind & 1 == FLIGHT:
            walls = pool.numbers[m, packed.CLEARANCE] < np.inf
            rise[lane] = _MANY.SAG * a[_MANY.CHANGE + lane] * length if walls else np.inf
        ends = max(abs(pool.numbers[m, STATE]), abs(a[_MANY.Y0 + lane]))
        if ends + rise[lane] > pool.largest[m]:
            for k in range(order + 1):
                series[k] = a[_MANY.X + k * LANES + lane]
            pool.largest[m] = extremum(series, order, length, pool.largest[m])


@kernel
def advance_some(pool, chosen, arrived):
    """Advance the trajectories of a pool until at least one has ended. Return how many have ended.

    `arrived` (LANES,) receives the indices of ended trajectories. `chosen` (LANES,) is overwritten.
    """
    ended = 0
    a, d = pointer(pool.a), pointer(pool.d)
    while ended == 0:
        count, kind = choose(pool, chosen)
        gather(pool, chosen, kind)
        if kind & 1 == FLIGHT:
            flight_step(a)
            if kind >= FLIGHT_WITH_TANGENT:
                flight_tangents(a, d)
        else:
            contact_step(a)
            if kind >= FLIGHT_WITH_TANGENT:
                contact_tangents(a, d)
        if pool.largest[chosen[0]] >= 0.0:
            raise_largest(pool, chosen, count, kind)
        ended = scatter(pool, chosen, count, kind, arrived)
    return ended


@kernel
def advance(parameters, states, sides, starts, ends, tolerance, contacts, largest=None):
    """Integrate trajectories, each from its start time to its end time.

    The final states replace `states` (n, 4). The walls in contact at the end (-1 or 1, 0 in flight)
    replace `sides` (n,). `contacts` (n,) receives the number of contacts that began. `largest` (n,)
    receives the largest |Z1| of each trajectory, or infinity after an escape.
    """
    size = min(len(states), RESIDENT)
    pool, taken = make_pool(size), np.zeros(size, np.int64)
    chosen, vacant = np.empty(LANES, np.int64), np.arange(max(size, LANES))
    begun, left, count = 0, len(states), size
    while left > 0:
        for m in vacant[:count]:
            if begun < len(states):
                taken[m] = i = begun
                begun += 1
                enter(pool, m, parameters[i], states[i], sides[i], tolerance)
                if largest is not None:
                    pool.largest[m] = abs(states[i, 0])
                send(pool, m, starts[i], ends[i], False)
        count = advance_some(pool, chosen, vacant)
        for m in vacant[:count]:
            i = taken[m]
            for k in range(4):
                states[i, k] = pool.numbers[m, STATE + k]
            sides[i] = np.int64(pool.numbers[m, SIDE])
            contacts[i] = pool.contacts[m]
            if largest is not None:
                largest[i] = pool.largest[m]
            left -= 1
