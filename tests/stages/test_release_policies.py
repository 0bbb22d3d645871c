"""Policies of migration: against SciPy's integrator, and consistent trials."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import solve_ivp
from scipy.stats import binom

from impact_damper.migration.policies import DRAWS, HOLD, STATE, Policy, hold, run_trials
from impact_damper.migration.release_set import depth_of, release_set, signed_distance
from impact_damper.stages.basins import free_attractors
from impact_damper.stages.release_policies import PHASES, quantile, release_policies
from impact_damper.system.packed import pack
from impact_damper.system.parameters import Damper, Oscillator
from impact_damper.system.settling import Settling

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)
W = 1.85


@pytest.fixture(scope="module")
def free():
    """Packed parameters without the damper, attractors, and the release set."""
    p = pack(CUBIC, None, W)
    attractors = free_attractors(p, np.array([3.0, 4.5]), Settling())
    return p, attractors, release_set(p, attractors, 0, PHASES, 32, Settling())


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


def test_a_hold_is_the_motion_of_scipy(free):
    p, attractors, releases = free
    draws = np.random.default_rng(4).random((5, DRAWS))
    starts = np.tile(attractors.centre[-1], (5, 1))
    arguments = np.full(5, 350.0), Policy(HOLD, 1.3), releases, np.zeros((5, 2)), 1e-10
    held = hold(pack(CUBIC, PAPER, W), p, starts, draws, *arguments)
    period = 2 * np.pi / W
    for draw, out in zip(draws, held, strict=True):
        strobe = np.pi / 2 / W
        on = strobe + draw[0] * period
        y = course(np.tile(attractors.centre[-1], 2), strobe, on, None)
        y[2:] = (2 * draw[1] - 1) * PAPER.clearance, 0.0
        y = course(y, on, on + 1.3 * period, PAPER)
        off = on + 1.3 * period
        y = course(y, off, off + out["ahead"] * period, None)
        assert_allclose(out["state"], y[:2], atol=2e-4)
        assert ((off - strobe) / period + out["ahead"]) % 1 == pytest.approx(0, abs=1e-9)


def test_distances_in_a_half_plane():
    inside = np.zeros((6, 6), bool)
    inside[:, 3:] = True
    assert_array_equal(signed_distance(inside)[0], [-2.5, -1.5, -0.5, 0.5, 1.5, 2.5])


def test_depth_tells_where_free_motions_of_scipy_settle(free):
    """Deep inside the release set every motion comes to the goal; far outside none does."""
    _, attractors, releases = free
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


def test_nothing_is_deep_beyond_the_grid(free):
    _, _, releases = free
    assert depth_of(releases.depth, releases.half, 0, 100.0, 0.0) == -np.inf


def test_trials_add_up_and_threads_do_not_matter(free):
    p, attractors, releases = free
    arguments = attractors, 0, Policy(STATE), releases, 30, 350.0, 3, Settling()
    one = run_trials(pack(CUBIC, PAPER, W), p, *arguments, 1)
    two = run_trials(pack(CUBIC, PAPER, W), p, *arguments, 2)
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


def test_the_dataset_of_a_small_comparison():
    data = release_policies(CUBIC, [PAPER], [W], noisy_frequency=W, trials=20, tested=800, cells=16)
    state, settled = (data.policy_success.sel(policy=name) for name in ("state", "settled"))
    assert state.sel(bound="lower").item() > settled.sel(bound="upper").item()
    test = [data[f"{name}_share"].sel(bound="share").item() for name in ("predicted", "realised")]
    # three standard errors of the realised share
    assert abs(test[0] - test[1]) < 3 * np.sqrt(test[1] * (1 - test[1]) / 800)
    assert np.all(data.least_impulse <= data.median_impulse)
    assert np.all(data.noisy_success.notnull())
