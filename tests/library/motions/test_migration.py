"""Migration control: runs compared with SciPy's integrator, and cases without a goal."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.stats import chi2

from impact_damper.data.datasets import flag
from impact_damper.data.shares import escape_rate
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.migration import migrate, release_case
from impact_damper.theory.free_oscillator import free_solutions

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)


def course(frequency, state, span, damper=None, times=None):
    """Return a motion by DOP853, with short steps through contacts if there is a damper."""

    def slope(t, y):
        push = 0.0
        if damper is not None:
            beyond = np.sign(y[2]) * max(abs(y[2]) - damper.clearance, 0.0)
            push = damper.contact_stiffness * beyond
        force = np.cos(frequency * t) - CUBIC.damping * y[1] - y[0] ** 3 - push
        relative = force - push / damper.mass_ratio if damper is not None else force
        return [y[1], force, y[3], relative]

    step = np.inf if damper is None else 2e-3
    return solve_ivp(
        slope, span, state, "DOP853", t_eval=times, rtol=1e-10, atol=1e-11, max_step=step
    ).y


@pytest.mark.parametrize("options", [{"longest_hold": 1}, {"release": "state"}], ids=str)
def test_course_of_a_run(options):
    """A run with an early release agrees with SciPy's integrator through both switchings."""
    run = migrate(CUBIC, PAPER, 1.95, seed=3, **options)
    here = release_case(CUBIC, PAPER, 1.95, Settling())
    on, off = float(run.on_time[0]), float(run.off_time[0])
    y = course(1.95, here.state, (np.pi / 2 / 1.95, on))[:, -1]
    place = np.random.default_rng(3).random((1, 3))[0, 1]
    y[2:] = (2 * place - 1) * PAPER.clearance, 0.0
    for first, last, damper in ((on, off, PAPER), (off, off + 15.0, None)):
        inside = (run.time >= first) & (run.time < last)
        times = np.append(run.time.values[inside], last)
        path = course(1.95, y, (first, last), damper, times)
        # SciPy's run does not locate contacts. The free transient amplifies the resulting error.
        assert_allclose(path[0, :-1], run.displacement.values[inside], atol=1e-4)
        y = path[:, -1]


def test_release_by_state_arrives_sooner():
    """At W = 1.7 no run arrives within 350 cycles if the motion has settled before the release."""
    goal = flag("trial_outcome", "reached")
    sooner = migrate(CUBIC, PAPER, 1.7, seed=0, release="state", periods=350)
    settled = migrate(CUBIC, PAPER, 1.7, seed=0, periods=350)
    assert sooner.trial_outcome == goal != settled.trial_outcome


@pytest.mark.parametrize("frequency", [1.31, 1.7, 2.014])
def test_scene(frequency):
    """Both free motions are found, also near their folds; sizes agree with harmonic balance."""
    known = release_case(CUBIC, PAPER, frequency, Settling()).known
    free = free_solutions(CUBIC, min(frequency, 2.0))
    assert_allclose(known, free.amplitude[[0, -1]], rtol=0.08)


@pytest.mark.parametrize("frequency", [1.2, 2.1])
def test_nothing_to_migrate_between(frequency):
    with pytest.raises(ValueError, match=f"frequency = {frequency}.*resonance"):
        migrate(CUBIC, PAPER, frequency)


def test_escape_rate():
    """A case equals a computation by hand. Intervals from random lifetimes hold the true rate."""
    rate = escape_rate(np.array([10, 20, 200]), horizon=80)
    assert_allclose(rate, np.array([2, *chi2.ppf([0.025, 0.975], [4, 6]) / 2]) / (10 + 20 + 80))
    generator = np.random.default_rng(0)
    held = [escape_rate(generator.exponential(500, 100), 1000) for _ in range(200)]
    covered = np.mean([low < 1 / 500 < high for _, low, high in held])
    assert covered > 0.9
    assert escape_rate(np.full(5, 1e9), 1000)[1] == 0
