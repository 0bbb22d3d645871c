"""Policies that decide when to switch the damper off, and trials of these policies.

Without the damper the oscillator has a large motion, the resonance motion, and a small one, the
non-resonance motion. Switching the damper on and off leads from one to the other, which is called
migration. A trial begins with the resonance motion. The damper is switched on at a random phase,
with the loose mass at rest relative to the primary mass at a random place in the gap. A hold is the
time with the damper on. It ends with the release, the moment at which the policy switches the
damper off. Then the free motion settles. The goal is the non-resonance motion. If the free motion
settles to another motion than the goal, another hold follows from this motion. A strobe is a time
at which the forcing has the phase W T = pi/2. The release set contains the states from which the
free motion settles to the goal. The policies release

    settled  at a random phase, after the states at the strobes repeat: the paper's policy
    hold     after a fixed number of forcing cycles
    phase    when a fixed phase of the forcing first occurs after a fixed number of cycles
    state    as soon as the measured state lies inside the release set, farther from its boundary
             than a fixed distance; without such a state after a fixed number of cycles

Z1 is the displacement of the primary mass and W the forcing frequency.
"""

import math
from typing import NamedTuple

import numpy as np

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.single import assign, side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, COUNT, FREQUENCY
from impact_damper.motions import ensemble
from impact_damper.motions.release_set import depth_of
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.motions.watch import NEAR, RING, nearby_period

SETTLED, HOLD, PHASE, STATE = range(4)
# A hold takes three random numbers: the phase at which the damper is switched on, the place of the
# loose mass at this time, and the phase of the release.
DRAWS = 3
# The results of one hold.
# released: whether it ended with a release.
# cycles, impacts: forcing cycles and impacts with the damper on.
# phase, depth: index of the phase of the release, and measured depth of the state inside the
#     release set (distance from its boundary).
# state, ahead: Z1 and Z1' at the next strobe, and forcing cycles from the release to this strobe.
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
    """A rule that decides when to release.

    Attributes
    ----------
    kind : int
        SETTLED, HOLD, PHASE or STATE.
    hold : float
        Forcing cycles with the damper on: exactly for HOLD, at least for PHASE, at most for STATE.
    phase : int
        For PHASE, the index of the phase among those of the release set.
    margin : float
        For STATE, the smallest depth inside the release set, in units of Z1.
    noise : float
        For STATE, the standard deviation of the error of the measured Z1. The standard deviation of
        the error of Z1' is W times this number.
    delay : int
        For STATE, the time from a measurement to the release. The unit is the time between two
        neighbouring phases of the release set.
    """

    kind: int
    hold: float = 0.0
    phase: int = 0
    margin: float = 0.0
    noise: float = 0.0
    delay: int = 0


@kernel_only
def switch_on(on, off, starts, draws, i, tolerance, y, work):
    """Integrate trial i without the damper up to the time at which the damper is switched on.

    y becomes the state at this time. Return the time and the wall in contact (-1, 1, or 0 for
    none).
    """
    y[0], y[1], y[2], y[3] = starts[i, 0], starts[i, 1], starts[i, 0], starts[i, 1]
    first = strobe_time(on)
    begin = first + draws[i, 0] * 2.0 * math.pi / on[FREQUENCY]
    advance(off, y, np.empty((0, 4)), 0, first, begin, tolerance, work)
    y[2], y[3] = (2.0 * draws[i, 1] - 1.0) * on[CLEARANCE], 0.0
    return begin, side_of(on, y)


@kernel
def hold_many(on, off, starts, draws, limits, rules, depth, half, noise, tolerance, held, stop):
    """Integrate each trial with the damper on until the release, then to the next strobe.

    Parameters
    ----------
    on, off : array, shape (packed.COUNT,)
        Packed parameters with and without the damper.
    starts : array, shape (n, 2)
        Z1 and Z1' at the strobe before switching on.
    draws : array, shape (n, DRAWS)
        Random numbers between 0 and 1.
    limits : array, shape (n,)
        Largest number of forcing cycles with the damper on.
    rules : tuple
        The fields of a `Policy`.
    depth, half : array
        The attributes of a `ReleaseSet`.
    noise : array, shape (m, 2)
        Standard normal numbers, errors of the measured Z1 and Z1'. Each trial begins at another
        row.
    tolerance : float
        Largest local error of a step.
    held : array of HELD, shape (n,)
        Receives the results.
    stop : array of bool, shape (1,)
        Another thread may set this flag to end the run.
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
                    measured = depth_of(depth, half, phase, x, v)
                    if measured > margin:
                        out.depth, waiting = measured, delay
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
    """Return the array of HELD from `hold_many`, computed on several threads.

    `free` is a `FreeCase`. The other arguments are those of `hold_many`.
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
    """Results of n trials.

    Attributes
    ----------
    reached : numpy.ndarray of bool, shape (n,)
        Whether the goal was reached within the limit.
    cycles : numpy.ndarray, shape (n,)
        Forcing cycles from the strobe before the first switching on until the free motion settles
        to the goal; infinite if the goal was not reached.
    damper : numpy.ndarray, shape (n,)
        Forcing cycles with the damper on.
    impacts : numpy.ndarray of int, shape (n,)
        Number of contacts begun.
    releases : numpy.ndarray of int, shape (n,)
        Number of releases.
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
    """The random numbers of trials. Policies with the same seed have the same random numbers.

    Attributes
    ----------
    noise : numpy.ndarray, shape (m, 2)
        Standard normal numbers, errors of measured states.
    """

    def __init__(self, seed, trials):
        self._generator, self._trials = np.random.default_rng(seed), trials
        self.noise = self._generator.standard_normal((4096 + trials, 2))

    def following(self):
        """Return numbers between 0 and 1 for the next hold of each trial.

        The array has the shape (trials, DRAWS + 1). The last number selects the strobe state of the
        free motion from which the hold begins, if this motion has several.
        """
        return self._generator.random((self._trials, DRAWS + 1))


def run_trials(on, free, policy, trials, limit, seed, examined=None):
    """Return the `Outcome` of trials of a policy.

    A free motion counts as settled when its state lies in a neighbourhood of an attractor from
    which all motions are proven to tend to the attractor (`attraction.attractors`).

    Parameters
    ----------
    on : array, shape (packed.COUNT,)
        Packed parameters with the damper.
    free : FreeCase
    policy : Policy
    trials : int
    limit : float
        Forcing cycles after which a trial ends.
    seed : int or sequence of int
    examined : int, optional
        Only the first `examined` trials are run; by default all. The random numbers are those of
        `trials` trials in either case.
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
        released = np.flatnonzero(held["released"])
        labels, periods = free.labels(held["state"][released])
        outcome.damper[open_] += held["cycles"]
        outcome.impacts[open_] += held["impacts"]
        spent[open_] += held["cycles"]
        rows = open_[released]
        spent[rows] += held["ahead"][released] + periods
        outcome.releases[rows] += 1
        outcome.reached[rows] = (labels == free.goal) & (spent[rows] <= limit)
        place[rows] = np.where(labels >= 0, labels, free.resonance)
        going = ~outcome.reached[rows] & (spent[rows] < limit) & (labels != free.goal)
        open_ = rows[going]
    outcome.cycles[outcome.reached] = spent[outcome.reached]
    return outcome
