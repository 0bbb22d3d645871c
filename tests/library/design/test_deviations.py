"""Samples and corners of tolerances, and whether starts agree with a claimed share."""

from dataclasses import replace

import numpy as np
import pytest
from helpers.design_tasks import compared, task
from scipy.stats import binom

from impact_damper.design import deviations
from impact_damper.design.choose import Choice, robust_gaps
from impact_damper.design.deviations import (
    CORNERS,
    FALSE_ALARM,
    SAMPLES,
    Cloud,
    choose_with_tolerances,
    corner_factors,
    promise,
    sampled_factors,
)
from impact_damper.design.task import VARIED

TOLERANCES = {"gap": 0.2, "restitution": 0.1, "stiffness": 0.05, "damping": 0.5, "force": 0.3}
TASK = task(tolerances=TOLERANCES)


def test_samples_lie_within_the_tolerances_one_in_each_part_of_every_one():
    factors = sampled_factors(TASK)
    assert (factors[0] == 1).all() and len(factors) == SAMPLES + 1
    for name, column in zip(VARIED, factors[1:].T, strict=True):
        width = TOLERANCES.get(name, 0.0)
        assert (abs(column - 1) <= width).all()
        if width:
            part = np.floor((column - 1 + width) / (2 * width) * SAMPLES)
            assert sorted(part) == list(range(SAMPLES))


def test_samples_are_those_of_the_seed():
    assert (sampled_factors(TASK) == sampled_factors(TASK)).all()
    assert (sampled_factors(TASK) != sampled_factors(task(tolerances=TOLERANCES, seed=7))).any()


@pytest.mark.parametrize("count", [1, 2, 4, 5])
def test_corners_are_distinct_and_off_by_the_whole_tolerance(count):
    tolerances = dict(list(TOLERANCES.items())[:count])
    factors = corner_factors(replace(TASK, tolerances=tolerances))
    assert (factors[0] == 1).all()
    assert len(np.unique(factors, axis=0)) == len(factors) == 1 + min(2**count, CORNERS)
    for name, column in zip(VARIED, factors[1:].T, strict=True):
        assert abs(column - 1) == pytest.approx(tolerances.get(name, 0.0))


def test_a_restitution_stays_at_most_1():
    given = replace(TASK, restitution=0.95)
    for factors in (sampled_factors(given), corner_factors(given)):
        assert factors[:, VARIED.index("restitution")].max() == pytest.approx(1 / 0.95)


def test_without_tolerances_only_the_nominal_values_are_run():
    given = replace(TASK, tolerances={})
    assert sampled_factors(given).shape == corner_factors(given).shape == (1, len(VARIED))


def cloud(least, starts=112, frequencies=9):
    least = np.asarray(least, float)
    share = np.stack([least, least, least], axis=-1)
    return Cloud(np.ones((len(least), len(VARIED))), least, share, least, starts, frequencies)


def test_a_claim_that_holds_is_rarely_taken_for_broken():
    """If the true share equals the claimed one at every frequency, by the binomial distribution."""
    made, claimed = cloud(np.ones(21)), 0.95
    level = FALSE_ALARM / (made.frequencies * len(made.least))
    refused = [k for k in range(made.starts + 1) if binom.cdf(k, made.starts, claimed) < level]
    chance = binom.cdf(max(refused), made.starts, claimed)
    assert 1 - (1 - chance) ** (made.frequencies * 21) <= FALSE_ALARM
    worst = cloud(np.r_[np.ones(20), max(refused) / made.starts])
    high = worst._replace(share=made.share)  # elsewhere in the band all starts are quiet
    assert list(high.keeps(claimed)) == [True] * 20 + [False]
    next_one = high._replace(least=np.r_[np.ones(20), (max(refused) + 1) / made.starts])
    assert next_one.keeps(claimed).all()


@pytest.mark.parametrize(
    ("share", "worst", "chosen"),
    [
        (lambda gap: 1.0, lambda gap: gap, "least"),
        (lambda gap: 1.0, lambda gap: -gap, "most"),
        # Displacements are smaller at larger gaps, but above 1.7 mm too few starts are quiet.
        (lambda gap: 1.0 if gap < 1.7 else 0.5, lambda gap: -gap, "below"),
        (lambda gap: gap / 10, lambda gap: gap, "most"),
    ],
)
def test_all_tolerances_together_choose_among_robust_gaps(monkeypatch, share, worst, chosen):
    def made_up_cloud(task, gap, factors, *_, **__):
        found = cloud([share(gap)] * len(factors))
        return found._replace(worst=np.full(len(factors), 10 + worst(gap)))

    monkeypatch.setattr(deviations, "run_cloud", made_up_cloud)
    gaps = np.geomspace(1, 3, 12)
    comparison = compared(gaps, np.ones((12, 1)), np.ones((12, 1)))
    robust = robust_gaps(comparison, TASK.share, 0.2)
    assert robust[0] == 1.25 and robust[-1] == 2.5  # 1/0.8 and 3/1.2
    gap = choose_with_tolerances(TASK, comparison, Choice(1.5, "robust")).gap
    if chosen == "below":
        assert 1.5 <= gap < 1.7
    else:
        assert gap == {"least": robust[0], "most": robust[-1]}[chosen]
    for kind in ("needs_tolerance", "least_worst"):
        choice = Choice(1.5, kind)
        assert choose_with_tolerances(TASK, comparison, choice) is choice


def test_without_other_tolerances_the_comparison_has_chosen():
    choice = Choice(1.5, "robust")
    assert choose_with_tolerances(replace(TASK, tolerances={"gap": 0.2}), None, choice) is choice


@pytest.mark.parametrize(
    ("kind", "samples", "unseen", "told"),
    [
        ("robust", [1, 1], [1, 1], "robust_kept"),
        ("robust", [1, 1], [1, 0.5], "broken"),
        ("robust", [1, 0.5], [1, 0.5], "nominal_kept"),
        ("robust", [1, 0.5], [0.5, 1], "broken"),
        ("needs_tolerance", [1, 0.5], [1, 0.5], "nominal_kept"),
        ("least_worst", [0.1, 0.1], [0.1, 0.1], "none_made"),
    ],
)
def test_what_is_promised(kind, samples, unseen, told):
    assert promise(TASK, kind, cloud(samples), cloud(unseen)) == told
