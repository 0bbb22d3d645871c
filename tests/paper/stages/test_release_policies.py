"""Release by state, and trials of rules of release, compared with SciPy's motions."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.stats import binom

from chatterjee1995.stages.release_policies import RULE, Trials, quantile, release_policies
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.attractors import PHASES, release_set
from impact_damper.motions.legs import HOLD, depth_of

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)
W = 1.85
ON = pack(CUBIC, PAPER, W)


@pytest.fixture(scope="module")
def trials():
    """Return trials with the paper's damper at W, with a coarse release set."""
    settling = Settling()
    return Trials(ON, release_set(CUBIC, W, settling, cells=32), settling)


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


@pytest.mark.thorough
def test_a_hold_agrees_with_scipy(trials):
    start, draws = trials.releases.attractors.centre[-1], np.random.default_rng(4).random((5, 3))
    rules = np.array([(HOLD, 1.3, 0)] * 5, RULE)
    held = trials.hold(np.tile(start, (5, 1)), draws, np.full(5, 350.0), rules)
    period = 2 * np.pi / W
    for draw, out in zip(draws, held, strict=True):
        strobe = np.pi / 2 / W
        on = strobe + draw[0] * period
        y = course(np.tile(start, 2), strobe, on, None)
        y[2:] = (2 * draw[1] - 1) * PAPER.clearance, 0.0
        y = course(y, on, on + 1.3 * period, PAPER)
        off = on + 1.3 * period
        y = course(y, off, off + out["ahead"] * period, None)
        assert_allclose(out["state"], y[:2], atol=2e-4)
        assert ((off - strobe) / period + out["ahead"]) % 1 == pytest.approx(0, abs=1e-9)


@pytest.mark.thorough
def test_depth_tells_where_free_motions_of_scipy_settle(trials):
    """Far inside the release set every motion settles to the goal, far outside no motion does."""
    attractors, releases = trials.releases.attractors, trials.releases
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


def test_the_interval_of_a_quantile_covers_it():
    """An interval of order statistics holds the median with a probability of at least 95 %."""
    middle, lower, upper = quantile(np.arange(100), 0.5)
    assert lower < middle < upper
    assert binom.cdf(upper, 100, 0.5) - binom.cdf(lower, 100, 0.5) >= 0.95


@pytest.mark.thorough
def test_the_dataset_of_a_small_comparison():
    data = release_policies(CUBIC, [PAPER], [W], trials=20, cells=16, settling=Settling())
    success = {name: data.policy_success.sel(policy=name) for name in data.policy.values}
    assert success["state"].sel(bound="lower").item() > success["settled"].sel(bound="upper").item()
