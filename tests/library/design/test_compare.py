"""Comparison of gaps: starts that become quiet late, second looks, and the chance of a mistake.

A look is a test of the share of quiet starts at a gap. The motions are made up: the first component
of a start is the number of cycles after which its motion becomes quiet.
"""

import numpy as np
import pytest
from helpers.design_tasks import compared, task
from scipy.stats import binom

from impact_damper.data.shares import failures_allowed
from impact_damper.design import compare as compare_module
from impact_damper.design.choose import choose, quiet_gaps
from impact_damper.design.compare import SECOND, TRIAL, compare
from impact_damper.motions.records import MOTION, SETTLED

STARTS = 73
TASK = task(starts=STARTS)
FREQUENCIES = np.array([20.4, 20.6])
NEVER = 10**6
# Cycles after which a motion becomes quiet: within a short run, and only within the full time.
EARLY, LATE = 50, TASK.hurried.limit + 1


@pytest.fixture
def made_up(monkeypatch):
    """A function that compares gaps whose starts become quiet after given times.

    The times have the shape (cases, starts). Further starts become quiet early. The function
    returns the comparison, and the number of starts that were run again for the full time.
    """

    def made_up_comparison(gaps, times, starts=STARTS):
        counted = []

        def draw(task, cases, count, stream, **_):
            states = np.zeros((len(cases), count, 4))
            states[..., 0] = EARLY
            states[:, : times.shape[1], 0] = times
            return states

        def run(task, cases, states, *, settling=None, **_):
            if settling is None:
                counted.append(states.shape[0] * states.shape[1])
            assert states.size  # never called without starts
            records = np.zeros(states.shape[:2], MOTION)
            records["outcome"] = SETTLED
            quiet = states[..., 0] <= (settling or task.effort.settling).limit
            records["maximum_displacement"] = np.where(quiet, 0.0, np.inf)
            return records

        monkeypatch.setattr(compare_module, "draw_starts", draw)
        monkeypatch.setattr(compare_module, "run_starts", run)
        found = compare(TASK, gaps, FREQUENCIES, 2.0, starts, "candidates")
        return found, sum(counted)

    return made_up_comparison


def test_starts_that_become_quiet_late_are_quiet(made_up):
    times = np.full((2, STARTS), EARLY)
    times[0, [3, TRIAL + 1]] = times[1, :TRIAL] = LATE
    found, run_again = made_up([8.0], times)
    assert quiet_gaps(found, TASK.share).all() and (found["start_count"].values == STARTS).all()
    assert run_again == 2 + TRIAL


def test_a_loud_start_is_judged_by_the_interval_of_more_starts(made_up):
    times = np.full((2, STARTS), EARLY)
    times[0, [3, 40]] = NEVER
    found, _ = made_up([8.0], times)
    assert list(found["start_count"].values[0]) == [SECOND * STARTS, STARTS]
    share = 1 - 2 / (SECOND * STARTS)
    assert found["start_quiet_share"].values[0] == pytest.approx([share, 1])
    assert found["start_quiet_interval"].values[0, 0, 0] >= TASK.share
    assert quiet_gaps(found, TASK.share).all()


@pytest.mark.parametrize("more", [0, 1])
def test_the_second_look_allows_as_many_as_its_interval(made_up, more):
    allowed = failures_allowed(TASK.share, SECOND * STARTS)
    times = np.full((2, SECOND * STARTS), EARLY)
    times[1, [5, *range(STARTS, STARTS + allowed - 1 + more)]] = NEVER
    found, _ = made_up([8.0], times)
    assert quiet_gaps(found, TASK.share)[0] == (more == 0)


def test_a_gap_is_given_up_as_soon_as_the_claim_is_lost(made_up):
    times = np.full((4, STARTS), EARLY)
    times[:2] = NEVER  # both frequencies of the first gap
    times[3, 0] = LATE
    found, run_again = made_up([8.0, 9.0], times)
    assert list(quiet_gaps(found, TASK.share)) == [False, True]
    assert list(found["start_count"].values.ravel()) == [TRIAL, TRIAL, STARTS, STARTS]
    allowed = failures_allowed(TASK.share, SECOND * STARTS)
    assert run_again == 2 * (allowed + 1) + 1


def test_starts_too_few_for_a_claim_must_all_be_quiet(made_up):
    times = np.full((4, 12), EARLY)
    times[2, 3] = NEVER
    found, _ = made_up([8.0, 9.0], times, starts=12)
    assert list(quiet_gaps(found, TASK.share)) == [True, False]
    assert (found["start_count"].values == 12).all()


@pytest.mark.parametrize("share", [0.8, 0.95, 0.99])
def test_two_looks_err_with_a_chance_below_five_per_cent(share):
    """The probability of a claim if the true share equals the claimed one, by the binomial law."""
    least = next(n for n in range(1, 1000) if failures_allowed(share, n) == 0)
    for starts in range(least, 3 * least, max(1, least // 16)):
        total, loud = SECOND * starts, 1 - share
        first, both = (failures_allowed(share, n) for n in (starts, total))
        late = np.arange(first + 1, both + 1)
        further = binom.cdf(both - late, total - starts, loud)
        chance = binom.cdf(first, starts, loud) + binom.pmf(late, starts, loud) @ further
        assert chance < 0.05


def candidates(monkeypatch, loud):
    """Result of `candidate_comparison` if the coarse comparison misses all violent motions.

    Motions are violent at gaps up to `loud` (mm).
    """

    def made_up(task, gaps, *_, **__):
        quiet = np.tile((np.asarray(gaps) > loud)[:, None], 2)
        return compared(gaps, np.where(quiet, 1.0, 0.9), np.where(quiet, 1.0, 9.0), 3.0)

    # In the coarse comparison all motions are quiet, and smaller for smaller gaps.
    gaps = np.geomspace(2, 12, 20)
    coarse = compared(gaps, np.ones((20, 2)), 1 + 0.01 * gaps[:, None] * np.ones(2), 3.0)
    monkeypatch.setattr(compare_module, "compare", made_up)
    return compare_module.candidate_comparison(TASK, coarse)


def test_candidates_beyond_loud_ones_are_compared(monkeypatch):
    found = candidates(monkeypatch, loud=4.0)
    assert choose(found, TASK.share, TASK.gap_tolerance).kind == "robust"
    gaps = found["candidate_gap"].values
    assert (np.diff(gaps) > 0).all() and len(gaps) > TASK.effort.candidates
    assert (quiet_gaps(found, TASK.share) == (gaps > 4.0)).all()


def test_no_further_candidates_if_all_are_quiet(monkeypatch):
    found = candidates(monkeypatch, loud=0.0)
    assert found.sizes["candidate"] == TASK.effort.candidates
    assert quiet_gaps(found, TASK.share).all()
