"""Policies of migration: motions compared with SciPy's integrator, and consistent trials.

A policy decides when to switch the damper off (release), so that the free oscillator settles to its
small motion, the goal. A hold is the time with the damper on. The release set contains the states
from which a release leads to the goal.

W is the forcing frequency.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import solve_ivp
from scipy.spatial import cKDTree
from scipy.stats import binom

from chatterjee1995.stages.release_policies import release_policies, under_disturbance
from chatterjee1995.stages.release_trials import PHASES, free_case, quantile
from impact_damper.data.shares import wilson
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.clairvoyant import clairvoyant, earliest
from impact_damper.motions.policies import (
    DRAWS,
    HOLD,
    PHASE,
    SETTLED,
    STATE,
    Draws,
    Policy,
    hold,
    run_trials,
)
from impact_damper.motions.policy_choice import HOLDS, expected_cycles
from impact_damper.motions.recorded import label_moments, record
from impact_damper.motions.release_set import depth_of, signed_distance
from impact_damper.orbits.boundary import saddles, stable_manifold

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)
W = 1.85


ON = pack(CUBIC, PAPER, W)


@pytest.fixture(scope="module")
def free():
    """The oscillator without the damper at W, with its release set."""
    return free_case(CUBIC, W, 32, Settling(), 1)


def course(state, begin, end, damper):
    """Return the last state of a motion by DOP853, with short steps through contacts."""

    def slope(t, y):
        push = 0.0
        if damper is not None:
            push = damper.contact_stiffness * np.sign(y[2]) * max(abs(y[2]) - damper.clearance, 0.0)
        force = np.cos(W * t) - CUBIC.damping * y[1] - y[0] ** 3 - push
        return [y[1], force, y[3], force - (push / damper.mass_ratio if damper else 0.0)]

    step = np.inf if damper is None else 2e-3
    accuracy = {"rtol": 1e-10, "atol": 1e-11, "max_step": step}
    return solve_ivp(slope, (begin, end), state, "DOP853", **accuracy).y[:, -1]


def some_holds(free, count):
    """Return starts on the resonance motion, and the random numbers of holds."""
    draws = np.random.default_rng(4).random((count, DRAWS))
    return np.tile(free.attractors.centre[-1], (count, 1)), draws


@pytest.mark.thorough
def test_a_hold_agrees_with_scipy(free):
    starts, draws = some_holds(free, 5)
    held = hold(ON, free, starts, draws, np.full(5, 350.0), Policy(HOLD, 1.3), np.zeros((5, 2)))
    period = 2 * np.pi / W
    for draw, out in zip(draws, held, strict=True):
        strobe = np.pi / 2 / W
        on = strobe + draw[0] * period
        y = course(np.tile(free.attractors.centre[-1], 2), strobe, on, None)
        y[2:] = (2 * draw[1] - 1) * PAPER.clearance, 0.0
        y = course(y, on, on + 1.3 * period, PAPER)
        off = on + 1.3 * period
        y = course(y, off, off + out["ahead"] * period, None)
        assert_allclose(out["state"], y[:2], atol=2e-4)
        assert ((off - strobe) / period + out["ahead"]) % 1 == pytest.approx(0, abs=1e-9)


@pytest.mark.parametrize("phase", [0, 5, 15])
def test_a_recording_passes_through_the_releases_of_a_policy(free, phase):
    starts, draws = some_holds(free, 20)
    recording = record(ON, free, starts, draws, np.full(20, 6.0))
    policy, most = Policy(PHASE, 4.0, phase), np.full(20, 50.0)
    held = hold(ON, free, starts, draws, most, policy, np.zeros((20, 2)))
    rows = np.arange(20)
    every = np.tile(np.arange(recording.depth.shape[1]), (20, 1))
    cycles = recording.cycles(rows[:, None], every)
    at = np.argmax((cycles >= 4) & (recording.phase(rows[:, None], every) == phase), axis=1)
    assert_allclose(recording.cycles(rows, at), held["cycles"], atol=1e-12)
    assert_allclose(recording.ahead(rows, at), held["ahead"], atol=1e-12)
    assert_array_equal(recording.impacts[rows, at], held["impacts"])
    assert_array_equal(recording.depth[rows, at], held["depth"])


def test_the_earliest_arrival_is_that_of_all_moments(free):
    """`earliest`, which skips moments outside the release set, misses no earlier arrival."""
    starts, draws = some_holds(free, 12)
    recording = record(ON, free, starts, draws, np.full(12, 15.0))
    rows, moments = np.nonzero(~np.isnan(recording.depth))
    none = np.full(len(rows), np.inf)
    labels, times = label_moments(free, recording, rows, moments, none)
    best = np.full(12, np.inf)
    np.minimum.at(best, rows, np.where(labels == free.goal, times, np.inf))
    arrival, at = earliest(free, recording, np.full(12, 100.0))
    assert_allclose(arrival, best)
    assert np.isfinite(best).sum() > 6
    hit = np.isfinite(arrival)
    assert np.all(recording.cycles(np.arange(12), at)[hit] < arrival[hit])


@pytest.mark.parametrize("damper", [PAPER, Damper(0.25, 1.0, 0.75)])
def test_no_policy_beats_the_clairvoyant_bound(free, damper):
    """In the same trials hardly any policy arrives earlier than the clairvoyant controller.

    The bound is not strict. The clairvoyant controller does not choose the free motion from which
    its next hold begins, so that in a few trials a policy begins from a better one.
    """
    on = pack(CUBIC, damper, W)
    bound = clairvoyant(on, free, 40, 350.0, 6)
    policies = Policy(SETTLED), Policy(HOLD, 8.0), Policy(PHASE, 2.0, 3), Policy(STATE, 8.0)
    for policy in policies:
        outcome = run_trials(on, free, policy, 40, 350.0, 6)
        assert np.sum(outcome.reached) <= np.sum(bound.reached)
        assert np.mean(outcome.cycles >= bound.cycles) >= 0.95
        assert np.median(outcome.cycles) >= np.median(bound.cycles)
    some = clairvoyant(on, free, 40, 350.0, 6, examined=10)
    assert_array_equal(some.cycles, bound.cycles[:10])
    threads = clairvoyant(on, free._replace(workers=2), 40, 350.0, 6)
    for first, second in zip(bound, threads, strict=True):
        assert_array_equal(first, second)


def test_a_huge_margin_never_releases(free):
    outcome = run_trials(ON, free, Policy(STATE, np.inf, margin=100.0), 5, 350.0, 3)
    assert np.all(outcome.releases == 0) and not np.any(outcome.reached)
    assert_allclose(outcome.damper, 350.0, atol=1 / PHASES)


def test_without_a_disturbance_the_success_is_that_of_the_policy(free):
    policy = Policy(STATE, 8.0)
    models = dict.fromkeys([(1.0, 1.0)], free)
    success, _ = under_disturbance(ON, models, policy, 20, 7, {"none": {}, "again": {"noise": 0.0}})
    outcome = run_trials(ON, free, policy, 20, 350.0, [7, 0])
    assert_allclose(success[:, 0], [wilson(np.sum(outcome.reached[:10]), 10)] * 2)


def test_expected_cycles_are_those_of_single_holds(free):
    """The estimate from recorded holds agrees with holds that are run with other random numbers."""
    of_hold, of_phase = expected_cycles(ON, free, 100, [1])
    assert of_phase.shape == (len(HOLDS), PHASES) and np.all(of_hold >= of_phase.min(axis=1))
    drawn = Draws(2, 400).following()
    starts = np.tile(free.attractors.centre[-1], (400, 1))
    most, none = np.full(400, 100.0), np.zeros((400, 2))
    held = hold(ON, free, starts, drawn[:, :DRAWS].copy(), most, Policy(HOLD, 8.0), none)
    labels, periods = free.labels(held["state"])
    hits = labels == free.goal
    expected = np.sum(held["cycles"] + held["ahead"] + periods) / np.sum(hits)
    spread = 3 * np.sqrt((1 / np.mean(hits) - 1) * (1 / 400 + 1 / 100))
    assert of_hold[HOLDS.index(8)] == pytest.approx(expected, rel=spread)


def test_distances_in_a_half_plane():
    inside = np.zeros((6, 6), bool)
    inside[:, 3:] = True
    assert_array_equal(signed_distance(inside)[0], [-2.5, -1.5, -0.5, 0.5, 1.5, 2.5])


@pytest.mark.thorough
def test_depth_tells_where_free_motions_of_scipy_settle(free):
    """Far inside the release set every motion settles to the goal; far outside none does."""
    attractors, releases = free.attractors, free.releases
    generator = np.random.default_rng(5)
    told = 0
    for k in range(60):
        phase = k % PHASES
        x, v = generator.uniform(-1, 1, 2) * [2.4, 4.0]
        depth = depth_of(releases.depth, releases.half, phase, x, v)
        if abs(depth) < 0.1:
            continue
        begin = 2 * np.pi * phase / PHASES / W
        end = np.pi / 2 / W + 60 * 2 * np.pi / W
        last = course([x, v, x, v], begin, end, None)[:2]
        nearest = np.argmin(np.linalg.norm(attractors.centre - last, axis=1))
        assert (attractors.owner[nearest] == 0) == (depth > 0)
        told += 1
    assert told > 15


def test_depth_is_the_distance_from_the_stable_manifold_to_a_cell():
    """At W = 1.7 there are two attractors, and the stable manifold of one saddle divides them."""
    free = free_case(CUBIC, 1.7, 32, Settling(), 1)
    grid, half = free.releases.depth, free.releases.half
    even = np.linspace(-0.5, 0.5, 9)[:, None] * half
    starts = np.stack(np.meshgrid(*even.T), axis=-1).reshape(-1, 2)
    (saddle,) = saddles(free.p, starts, [1], 0.0)
    spacing = 0.2 * 2 * half / grid.shape[1]
    pieces, complete = stable_manifold(saddle, 1e-9, half, spacing, 3 * half)
    assert complete
    states = np.random.default_rng(2).uniform(-1, 1, (4000, 2)) * half
    found = np.array([depth_of(grid, half, 0, x, v) for x, v in states]) / free.releases.cell
    scale = np.array([1, 1.7]) * free.releases.cell
    away = cKDTree(np.concatenate(pieces) / scale).query(states / scale)[0]
    close = np.abs(found) < 20
    apart = np.abs(np.abs(found) - away)[close]
    assert close.sum() > 1500 and np.median(apart) < 0.5 and np.mean(apart < 1) > 0.93


def test_nothing_is_deep_beyond_the_grid(free):
    releases = free.releases
    assert depth_of(releases.depth, releases.half, 0, 100.0, 0.0) == -np.inf


def test_trials_add_up_and_threads_do_not_matter(free):
    one = run_trials(ON, free, Policy(STATE, np.inf), 30, 350.0, 3)
    two = run_trials(ON, free._replace(workers=2), Policy(STATE, np.inf), 30, 350.0, 3)
    for first, second in zip(one, two, strict=True):
        assert_array_equal(first, second)
    assert np.all(one.cycles[one.reached] <= 350) and np.all(np.isinf(one.cycles[~one.reached]))
    assert np.all(one.damper <= one.cycles)
    assert np.all(one.releases[one.reached] >= 1)


def test_the_interval_of_a_quantile_covers_it():
    """The chance that the interval of order statistics holds the median is at least 95 %."""
    middle, lower, upper = quantile(np.arange(100), 0.5)
    assert lower < middle < upper
    assert binom.cdf(upper, 100, 0.5) - binom.cdf(lower, 100, 0.5) >= 0.95


@pytest.mark.thorough
def test_the_dataset_of_a_small_comparison():
    data = release_policies(
        CUBIC, [PAPER], [W], noisy_frequencies=[W], trials=20, tested=800, cells=16
    )
    success = {name: data.policy_success.sel(policy=name) for name in data.policy.values}
    assert success["state"].sel(bound="lower").item() > success["settled"].sel(bound="upper").item()
    assert success["clairvoyant"].sel(bound="share").item() == 1
    test = [data[f"{name}_share"].sel(bound="share").item() for name in ("predicted", "realised")]
    # three standard errors of the realised share
    assert abs(test[0] - test[1]) < 3 * np.sqrt(test[1] * (1 - test[1]) / 800)
    assert np.all(data.least_impulse <= data.median_impulse)
    assert np.all(data.disturbed_success.notnull())
