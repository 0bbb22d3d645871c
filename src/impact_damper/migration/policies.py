"""Policies of migration: when to let go of the damper, and what becomes of each release.

A trial begins on the free resonance motion. The damper is switched on at a random phase, with the
loose mass at rest relative to the primary at a random place in the gap, and switched off (released)
when the policy says so; the free motion then settles. If it settles on another motion than the goal
the trial goes on from there.

    settled  at a random phase, once the states at the strobes repeat: the paper's policy
    hold     after a fixed number of cycles
    phase    after a number of cycles, at a fixed phase of the forcing
    state    as soon as the measured state lies inside the release set by a margin; after a number
             of cycles without such a state in any case, for another try
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.single import advance, assign, side_of, workspace
from impact_damper.migration.release_set import depth_of
from impact_damper.motions import ensemble
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.motions.watch import NEAR, RING, nearby_period
from impact_damper.system.packed import CLEARANCE, COUNT, FREQUENCY

SETTLED, HOLD, PHASE, STATE = range(4)
# Random numbers of a hold: phase of switching on, place of the loose mass, phase of the release.
DRAWS = 3
HELD = np.dtype(
    [
        ("released", "?"),
        ("cycles", "f8"),
        ("impacts", "i8"),
        ("phase", "i8"),
        ("depth", "f8"),
        ("state", "f8", 2),
        ("ahead", "f8"),
    ]
)


class Policy(NamedTuple):
    """When to release.

    Attributes
    ----------
    kind : int
        SETTLED, HOLD, PHASE or STATE.
    hold : float
        Forcing periods with the damper on: exactly for HOLD, at least for PHASE, at most for STATE.
    phase : int
        Of PHASE: index of the phase among those of the release set.
    margin : float
        Of STATE: least depth inside the release set, in units of Z1.
    noise : float
        Standard deviation of the error of the measured Z1, and W times it of Z1'.
    delay : int
        Steps between two phases from a measurement to the release.
    """

    kind: int
    hold: float = 0.0
    phase: int = 0
    margin: float = 0.0
    noise: float = 0.0
    delay: int = 0


@kernel_only
def switch_on(on, off, starts, draws, i, tolerance, y, work):
    """Run trial i freely to its switching on; set y there, return the time and the wall touched."""
    y[0], y[1], y[2], y[3] = starts[i, 0], starts[i, 1], starts[i, 0], starts[i, 1]
    first = strobe_time(on)
    begin = first + draws[i, 0] * 2.0 * math.pi / on[FREQUENCY]
    advance(off, y, np.empty((0, 4)), 0, first, begin, tolerance, work)
    y[2], y[3] = (2.0 * draws[i, 1] - 1.0) * on[CLEARANCE], 0.0
    return begin, side_of(on, y)


@kernel
def hold_many(on, off, starts, draws, limits, rules, depth, half, noise, tolerance, held, stop):
    """Hold the damper in each trial until its release or a limit, and run freely to a strobe.

    Parameters
    ----------
    on, off : array, shape (packed.COUNT,)
        Packed parameters with and without the damper.
    starts : array, shape (n, 2)
        Z1 and Z1' at the strobe before switching on.
    draws : array, shape (n, DRAWS)
        Numbers from 0 to 1.
    limits : array, shape (n,)
        Forcing periods with the damper on at most.
    rules : tuple
        A `Policy`.
    depth, half : array
        Of the `ReleaseSet`.
    noise : array, shape (m, 2)
        Standard normal numbers; each trial begins at another of them.
    tolerance : float
        Local error allowed.
    held : array of HELD, shape (n,)
        Gets the forcing periods and the impacts with the damper on, the phase and the measured
        depth at the release, and the state at the next strobe with the forcing periods until then.
    stop : array of bool, shape (1,)
        Set to true by another thread, it ends the run.
    """
    kind, length, wanted, margin, size, delay = rules
    none, work = np.empty((0, 4)), workspace()
    phases = depth.shape[0]
    period = 2.0 * math.pi / on[FREQUENCY]
    step = period / phases
    ring, y = np.empty((RING, 4)), np.empty(4)
    for i in range(len(starts)):
        if stop[0]:
            return
        out = held[i]
        begin, side = switch_on(on, off, starts, draws, i, tolerance, y, work)
        k = int(math.floor(begin / step)) + 1
        t, waiting, release, strobes = begin, -1, math.inf, 0
        if kind == HOLD or kind == STATE:
            release = begin + length * period
        out.impacts, out.depth = 0, math.nan
        out.released = True
        while True:
            end = min(k * step, release)
            side, contacts, _ = advance(on, y, none, side, t, end, tolerance, work)
            out.impacts += contacts
            t = end
            if t >= release:
                break
            if t - begin >= limits[i] * period:
                out.released = False
                break
            phase = k % phases
            k += 1
            if kind == SETTLED and phase == phases // 4 and release == math.inf:
                assign(ring[strobes % RING], y)
                n = nearby_period(ring, strobes, 1.0, 20.0 * tolerance, NEAR)
                strobes += 1
                if n > 0:
                    release = t + draws[i, 2] * n * period
            elif kind == PHASE and phase == wanted and t - begin >= length * period:
                out.depth = depth_of(depth, half, phase, y[0], y[1])
                break
            elif kind == STATE:
                if waiting < 0:
                    m = (i * 7919 + k) % len(noise)
                    x = y[0] + size * noise[m, 0]
                    v = y[1] + size * on[FREQUENCY] * noise[m, 1]
                    found = depth_of(depth, half, phase, x, v)
                    if found > margin:
                        out.depth, waiting = found, delay
                if waiting == 0:
                    break
                waiting -= waiting > 0
        out.cycles = (t - begin) / period
        out.phase = int(math.floor(t / step + 0.5)) % phases
        first = strobe_time(on)
        count = math.ceil((t - first) / period - 1e-12)
        advance(off, y, none, 0, t, first + count * period, tolerance, work)
        out.ahead = first / period + count - t / period
        out.state[0], out.state[1] = y[0], y[1]


def hold(on, free, starts, draws, limits, policy, noise):
    """Return the array of HELD of `hold_many`, computed on several threads.

    `free` is the `FreeCase`.
    """
    held, stop = np.zeros(len(starts), HELD), np.zeros(1, bool)
    assert on.shape == free.p.shape == (COUNT,)

    def work(part):
        hold_many(
            on,
            free.p,
            starts[part],
            draws[part],
            limits[part],
            tuple(policy),
            free.releases.depth,
            free.releases.half,
            noise[part.start :],
            free.settling.tolerance,
            held[part],
            stop,
        )

    work(slice(0, 0))
    ensemble.run_chunks(work, len(starts), free.workers, None, stop, size=8)
    return held


class Outcome(NamedTuple):
    """What became of trials, each an array of shape (n,).

    Attributes
    ----------
    reached : whether the goal was reached within the limit
    cycles : forcing periods from the first switching on to the free motion's settling on the goal,
        infinite if it is not reached
    damper : forcing periods with the damper on
    impacts : contacts begun
    releases : number of releases
    """

    reached: np.ndarray
    cycles: np.ndarray
    damper: np.ndarray
    impacts: np.ndarray
    releases: np.ndarray

    @classmethod
    def failed(cls, trials):
        """Return the outcome of trials in which the damper is never switched on."""
        none = np.zeros(trials, int)
        reached, cycles = np.zeros(trials, bool), np.full(trials, np.inf)
        return cls(reached, cycles, np.zeros(trials), none, none.copy())


class Draws:
    """The random numbers of trials, which are the same for each policy with the same seed.

    Attributes
    ----------
    noise : numpy.ndarray, shape (m, 2)
        Standard normal numbers.
    """

    def __init__(self, seed, trials):
        self._generator, self._trials = np.random.default_rng(seed), trials
        self.noise = self._generator.standard_normal((4096 + trials, 2))

    def following(self):
        """Return numbers from 0 to 1 for the next hold of each trial, shape (trials, DRAWS + 1).

        The last one chooses the passage of the free motion at which the hold begins.
        """
        return self._generator.random((self._trials, DRAWS + 1))


def run_trials(on, free, policy, trials, limit, seed, examined=None):
    """Return the `Outcome` of trials of a policy.

    A free motion counts as settled in a proven neighbourhood of an attractor.

    Parameters
    ----------
    on : array, shape (packed.COUNT,)
        Packed parameters with the damper.
    free : FreeCase
    policy : Policy
    trials : int
    limit : float
        Forcing periods after which a trial ends.
    seed : int or sequence of int
    examined : int, optional
        Number of the first trials that are run; all of them by default.
    """
    random, examined = Draws(seed, trials), examined or trials
    place = np.full(examined, free.resonance)
    spent, outcome = np.zeros(examined), Outcome.failed(examined)
    open_ = np.arange(examined)
    while len(open_):
        draws = random.following()[open_]
        starts = free.strobe_states(place[open_], draws[:, DRAWS])
        left = limit - spent[open_]
        held = hold(on, free, starts, draws[:, :DRAWS].copy(), left, policy, random.noise)
        let_go = np.flatnonzero(held["released"])
        labels, periods = free.labels(held["state"][let_go])
        outcome.damper[open_] += held["cycles"]
        outcome.impacts[open_] += held["impacts"]
        spent[open_] += held["cycles"]
        let = open_[let_go]
        spent[let] += held["ahead"][let_go] + periods
        outcome.releases[let] += 1
        outcome.reached[let] = (labels == free.goal) & (spent[let] <= limit)
        place[let] = np.where(labels >= 0, labels, free.resonance)
        going = ~outcome.reached[let] & (spent[let] < limit) & (labels != free.goal)
        open_ = let[going]
    outcome.cycles[outcome.reached] = spent[outcome.reached]
    return outcome
