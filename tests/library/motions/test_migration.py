"""Migration control: runs compared with SciPy's integrator, and consistent totals.

The controller switches the damper on and off (release) until the oscillator settles on its small
motion, the goal.

W is the forcing frequency. Free means without the damper. The quiet orbit is the small symmetric
periodic motion for which a damper is designed.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import solve_ivp
from scipy.stats import CensoredData, chi2, ecdf

from chatterjee1995.stages.release_scan import release_scan
from impact_damper.data.datasets import flag
from impact_damper.data.shares import escape_rate, survival
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.migration import migrate, trials
from impact_damper.motions.releases import release_case
from impact_damper.theory.free_oscillator import free_solutions

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)
SMALL = {"trials": 20, "releases": 40, "lifetime": 1000, "longest_hold": 20}


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


@pytest.fixture(scope="module")
def runs():
    return trials(CUBIC, PAPER, 1.85, **SMALL)


def test_every_run_ends_once(runs):
    """Switchings follow each other in time until the goal is reached, and all are counted."""
    goal = flag("destination", "non_resonance")
    made = runs.destination.values != flag("destination", "none")
    assert_array_equal(made.sum(axis=1), runs.switchings)
    assert int(runs.destination_count.sum()) == int(runs.switchings.sum())
    assert_array_equal(
        np.any(runs.destination == goal, axis=1),
        runs.trial_outcome == flag("trial_outcome", "reached"),
    )
    for row, count in zip(runs.destination.values, runs.switchings.values, strict=True):
        assert goal not in row[: count - 1]
    for before, after in (("on_time", "off_time"), ("off_time", "end_time")):
        assert np.all((runs[before] < runs[after]).values[made])
    assert np.all(runs.damper_time <= runs.release_time)
    assert np.all(runs.release_time < runs.total_time)


def test_a_single_run_repeats_the_trial(runs):
    """`migrate` with the seed of the trial `example` gives the same switchings and displacement."""
    example = int(runs.example)
    seed = np.random.SeedSequence(1995).spawn(2)[0].spawn(SMALL["trials"])[example]
    one = migrate(CUBIC, PAPER, 1.85, seed=seed, longest_hold=20)
    count = int(one.switchings)
    for name in ("on_time", "off_time", "end_time", "destination", "released_from"):
        assert_array_equal(one[name], runs[name].values[example, :count])
    assert_array_equal(one.displacement, runs.displacement)


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
        # SciPy's run does not locate contacts, and the free transient amplifies this error.
        assert_allclose(path[0, :-1], run.displacement.values[inside], atol=1e-4)
        y = path[:, -1]


def test_release_by_state_arrives_sooner():
    """At W = 1.7 no run arrives within 350 cycles if the motion has settled before the release."""
    goal = flag("trial_outcome", "reached")
    sooner = [migrate(CUBIC, PAPER, 1.7, seed=k, release="state", periods=350) for k in range(3)]
    settled = [migrate(CUBIC, PAPER, 1.7, seed=k, periods=350) for k in range(3)]
    assert np.sum([run.trial_outcome == goal for run in sooner]) >= 2
    assert not np.any([run.trial_outcome == goal for run in settled])
    with pytest.raises(ValueError, match="release = 'later': must be 'settled' or 'state'"):
        migrate(CUBIC, PAPER, 1.7, release="later")


@pytest.mark.parametrize("row", [1, 2])
def test_releases(runs, row):
    """Releases of the quiet motion and of the motion of period 3 lead where SciPy's runs lead."""
    maxima = {}
    for k in range(0, 40, 4):
        begin = (float(runs.release_phase[row, k]) % 1 + 0.25) * 2 * np.pi / 1.85
        state = [float(runs[f"release_{name}"][row, k]) for name in ("displacement", "velocity")]
        times = begin + np.linspace(200, 230, 3000)
        path = course(1.85, state * 2, (begin, times[-1]), times=times)
        maxima.setdefault(int(runs.release_destination[row, k]), []).append(np.abs(path[0]).max())
    for name, displacement in (("non_resonance", 0.29604), ("subharmonic", 0.84606)):
        assert_allclose(
            maxima.pop(flag("destination", name), displacement), displacement, atol=1e-3
        )
    assert not maxima


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


def test_survival():
    """Survival agrees with SciPy's Kaplan-Meier estimate.

    Runs that last longer than the horizon are censored: only a lower bound of their life is known.
    """
    lives = np.array([3, 12, 12, 25, 40, 77, 100, 100])
    times = np.array([0, 10, 12, 30, 80])
    data = CensoredData(uncensored=lives[lives <= 80], right=np.full(2, 80))
    estimate = survival(lives, 80, times)
    assert_allclose(estimate[:, 0], ecdf(data).sf.evaluate(times))
    assert np.all((estimate[:, 1] <= estimate[:, 0]) & (estimate[:, 0] <= estimate[:, 2]))
    with pytest.raises(ValueError, match="horizon"):
        survival(lives, 70, times)


def test_escape_rate():
    """A case computed by hand; and intervals from random lifetimes mostly contain the true rate."""
    rate = escape_rate(np.array([10, 30, 40, 200]), horizon=100, lead=20)
    assert_allclose(rate, np.array([2, *chi2.ppf([0.025, 0.975], [4, 6]) / 2]) / (10 + 20 + 80))
    generator = np.random.default_rng(0)
    held = [escape_rate(generator.exponential(500, 100), 1000, 0) for _ in range(200)]
    covered = np.mean([low < 1 / 500 < high for _, low, high in held])
    assert covered > 0.9
    assert escape_rate(np.full(5, 1e9), 1000, 0)[1] == 0


def test_release_scan():
    """At W = 1.73 releases from the quiet motion lead to a motion that does not exist at W = 1.7.

    This is the free motion of period 3.
    """
    scan = release_scan(CUBIC, PAPER, [1.7, 1.73], starts=16, releases=10, lifetime=60)
    quiet = scan.damped_kind == flag("damped_kind", "quiet")
    assert_array_equal(quiet.sum("damped"), [1, 1])
    shares = scan.release_share.sel(bound="share").where(quiet).sum("damped")
    assert_array_equal(shares.sel(free_motion="non_resonance"), [1, 0])
    assert_array_equal(shares.sel(free_motion="subharmonic"), [0, 1])
