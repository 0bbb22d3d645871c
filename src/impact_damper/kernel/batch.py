"""The event-driven flow of many trajectories, LANES of which are stepped side by side.

All trajectories of a step must be in the same phase, in flight or in contact. So a pool holds more
trajectories than there are lanes, with a queue for each kind of step, and each step takes those of
the longest queue. The result for a trajectory does not depend on the others.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.kernel import instances
from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.equation import no_return
from impact_damper.kernel.memory import aligned, pointer
from impact_damper.system import packed

LANES = 16
# Trajectories in a pool: enough for the longest queue to fill all lanes nearly always.
RESIDENT = 64
FLIGHT, CONTACT, FLIGHT_WITH_TANGENT, CONTACT_WITH_TANGENT = range(4)

_MANY = instances.instance(LANES)
flight_step, contact_step, flight_tangents, contact_tangents = instances.bound_steps(_MANY)
SIZE, TANGENT_SIZE = _MANY.SIZE, _MANY.TANGENT_SIZE
# Indices of the numbers of a trajectory in a pool, which stand in the order of the rows of a step.
STATE, SIDE, TIME, LONGEST, TOLERANCE, LENGTH = (
    row // LANES
    for row in (_MANY.Y0, _MANY.SIDE, _MANY.TIME, _MANY.LONGEST, _MANY.TOLERANCE, _MANY.LENGTH)
)


class Pool(NamedTuple):
    """Trajectories that are being integrated, each to its own end.

    Attributes
    ----------
    numbers : array, shape (m, LENGTH)
        Parameters, state, side, time, longest step and tolerance.
    ends : array, shape (m,)
        Times to stop at.
    farthest : array, shape (m,)
        |Z1| from which they escape (`equation.no_return`).
    tangents : array, shape (m, 4)
    queues : array of int, shape (4, m)
        Indices of the trajectories that wait for a step of each kind: in flight, in contact, and
        both with a tangent.
    waiting : array of int, shape (4,)
        Lengths of the queues.
    contacts : array of int, shape (m,)
        Contacts begun since the trajectory was last sent.
    held : array of int, shape (LANES,)
        Index of the trajectory whose parameters stand in each lane, or -1.
    a, d : array
        Rows of the step and of its tangents (`series.rows`).
    """

    numbers: np.ndarray
    ends: np.ndarray
    farthest: np.ndarray
    tangents: np.ndarray
    queues: np.ndarray
    waiting: np.ndarray
    contacts: np.ndarray
    held: np.ndarray
    a: np.ndarray
    d: np.ndarray


@kernel
def make_pool(size):
    """Return an empty pool."""
    return Pool(
        np.zeros((size, LENGTH)),
        np.zeros(size),
        np.zeros(size),
        np.zeros((size, 4)),
        np.zeros((4, size), np.int64),
        np.zeros(4, np.int64),
        np.zeros(size, np.int64),
        np.full(LANES, -1),
        aligned(SIZE),
        aligned(TANGENT_SIZE),
    )


@kernel
def enter(pool, m, p, y, side, tolerance):
    """Write a trajectory into a pool, at index m. It is integrated once `send` is called."""
    numbers = pool.numbers[m]
    for i in range(packed.COUNT):
        numbers[i] = p[i]
    for i in range(4):
        numbers[STATE + i] = y[i]
    numbers[SIDE] = side
    numbers[TOLERANCE] = tolerance
    pool.farthest[m] = no_return(p)
    for lane in range(LANES):
        if pool.held[lane] == m:
            pool.held[lane] = -1


@kernel
def send(pool, m, t, end, with_tangent):
    """Let a trajectory be integrated from t to its next end."""
    pool.numbers[m, TIME] = t
    pool.ends[m] = end
    pool.contacts[m] = 0
    phase = CONTACT if pool.numbers[m, SIDE] != 0.0 else FLIGHT
    enqueue(pool.queues, pool.waiting, m, phase + (FLIGHT_WITH_TANGENT if with_tangent else 0))


@kernel_only
def enqueue(queues, waiting, m, kind):
    """Append a trajectory to the queue for a kind of step."""
    queues[kind, waiting[kind]] = m
    waiting[kind] += 1


@kernel
def choose(pool, chosen):
    """Take up to LANES trajectories from the longest queue. Return their number and their kind."""
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
    """Copy the chosen trajectories into the lanes, their parameters only if these change.

    If there are fewer than LANES, `choose` has put one of them into several lanes.
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
    """Copy the trajectories back, and append those that are not at their ends to the queues.

    A trajectory that has escaped (`equation.no_return`) counts as at its end, with the state at
    the escape. Return how many are at their ends; `arrived` gets their indices.
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
        if length >= numbers[LONGEST] or gone:
            numbers[TIME] = pool.ends[m]
            arrived[ended] = m
            ended += 1
        else:
            numbers[TIME] += length
            phase = CONTACT if touching else FLIGHT
            enqueue(pool.queues, pool.waiting, m, (kind & FLIGHT_WITH_TANGENT) + phase)
    return ended


@kernel
def advance_some(pool, chosen, arrived):
    """Step trajectories of the pool until some are at their ends.

    Parameters
    ----------
    pool : Pool
        Must not be empty.
    chosen, arrived : array of int, shape (LANES,)
        `chosen` is scratch; `arrived` gets the indices of the trajectories at their ends.

    Returns
    -------
    int
        Number of trajectories at their ends.
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
        ended = scatter(pool, chosen, count, kind, arrived)
    return ended


@kernel
def advance(parameters, states, sides, starts, ends, tolerance, contacts):
    """Integrate trajectories, each from its start to its end.

    Parameters
    ----------
    parameters : array, shape (m, packed.COUNT)
        Packed parameters (`packed.pack`).
    states : array, shape (m, 4)
        Z1, Z1', Z2, Z2'; replaced.
    sides : array of int, shape (m,)
        Walls in contact, -1 or 1, or 0 in flight; replaced.
    starts, ends : array, shape (m,)
        Times, ends not before starts.
    tolerance : float
        Local error allowed.
    contacts : array of int, shape (m,)
        Gets the numbers of contacts begun.
    """
    size = min(len(states), RESIDENT)
    pool = make_pool(size)
    chosen, arrived = np.empty(LANES, np.int64), np.empty(LANES, np.int64)
    taken = np.zeros(size, np.int64)
    following = size
    for m in range(size):
        taken[m] = m
        enter(pool, m, parameters[m], states[m], sides[m], tolerance)
        send(pool, m, starts[m], ends[m], False)
    left = len(states)
    while left > 0:
        for j in range(advance_some(pool, chosen, arrived)):
            m = arrived[j]
            i = taken[m]
            for k in range(4):
                states[i, k] = pool.numbers[m, STATE + k]
            sides[i] = np.int64(pool.numbers[m, SIDE])
            contacts[i] = pool.contacts[m]
            left -= 1
            if following < len(states):
                taken[m] = i = following
                following += 1
                enter(pool, m, parameters[i], states[i], sides[i], tolerance)
                send(pool, m, starts[i], ends[i], False)
