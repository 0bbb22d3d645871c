"""Choice of a gap from a table of outcomes, against brute force."""

import numpy as np
import pytest
from helpers.design_tasks import compared

from impact_damper.data.sweeps import runs_of_true
from impact_damper.design.choose import buildable, choose, middle_gap, quiet_gaps, worst_sizes

SHARE = 0.95


def table(worst, shares):
    """Return a comparison over gaps of 1 to 4 mm."""
    return compared(np.geomspace(1, 4, len(shares)), shares, worst)


def made_up(seed, quiet):
    """Comparison with random displacements; about the share `quiet` of the gaps is quiet."""
    generator = np.random.default_rng(seed)
    count = generator.integers(8, 16)
    loud = np.cumsum(generator.normal(size=count))  # neighbours are alike
    loud = loud > np.quantile(loud, quiet)
    shares = np.where(loud[:, None], generator.uniform(0.1, 0.9, (count, 2)), 1.0)
    return table(np.exp(generator.normal(size=(count, 2))), shares)


def judged(comparison, gap, tolerance):
    """Return three numbers on the gaps within a tolerance of a gap, by brute force.

    They are the worst displacement, whether all gaps are quiet, and the largest share of starts
    that are not quiet.
    """
    gaps, are_quiet = comparison["candidate_gap"].values, quiet_gaps(comparison, SHARE)
    low, high = gap * (1 - tolerance), gap * (1 + tolerance)
    # Displacement and share are interpolated, so they are largest at an end or at a compared gap.
    tried = np.log([low, *gaps[(gaps > low) & (gaps < high)], high])
    worst = np.exp(np.interp(tried, np.log(gaps), np.log(worst_sizes(comparison)))).max()
    shares = comparison["start_quiet_share"].values.mean(axis=1)
    loud = np.interp(tried, np.log(gaps), 1 - shares).max()
    quiet = low >= gaps[0] and high <= gaps[-1]
    quiet &= are_quiet[(gaps >= low) & (gaps <= high)].all()
    for k in range(len(gaps) - 1):
        if low < gaps[k + 1] and high > gaps[k]:
            quiet &= are_quiet[k : k + 2].all()
    return worst, quiet, loud


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("share", [0.9, 0.4, 0.0])
@pytest.mark.parametrize("tolerance", [0.0, 0.08, 0.2])
def test_the_choice_is_that_of_brute_force(seed, share, tolerance):
    comparison = made_up(seed, share)
    choice = choose(comparison, SHARE, tolerance)
    coarse = buildable(1, 4)
    found = [judged(comparison, gap, tolerance) for gap in coarse]
    worst, quiet, loud = map(np.array, zip(*found, strict=True))
    here = judged(comparison, choice.gap, tolerance)
    if choice.kind == "robust":
        assert here[1] and here[0] <= worst[quiet].min() * 1.0011
        return
    assert not quiet.any()
    if choice.kind == "needs_tolerance":
        gaps = comparison["candidate_gap"].values
        runs = [(gaps[a], gaps[b - 1]) for a, b in runs_of_true(quiet_gaps(comparison, SHARE))]
        widths = [np.log(high / low) for low, high in runs]
        assert any(
            low <= choice.gap <= high
            for (low, high), width in zip(runs, widths, strict=True)
            if width >= max(widths) - 2e-3
        )
        return
    assert not quiet_gaps(comparison, SHARE).any()
    covered = (coarse * (1 - tolerance) >= 1) & (coarse * (1 + tolerance) <= 4)
    assert here[2] <= loud[covered].min() + 0.0011


def test_a_narrow_quiet_range_needs_a_closer_tolerance():
    shares = np.ones((9, 2))
    shares[[0, 1, 2, 5, 6, 7, 8], 1] = 0.5
    comparison = table(np.ones((9, 2)), shares)
    gaps, choice = comparison["candidate_gap"], choose(comparison, SHARE, 0.2)
    assert choice.kind == "needs_tolerance" and gaps[3] <= choice.gap <= gaps[4]
    assert choose(comparison, SHARE, 0.05).kind == "robust"


def test_one_loud_frequency_makes_a_gap_loud():
    shares = np.ones((4, 2))
    shares[2, 1] = 0.98  # its confidence interval, from 0.94, reaches below the required 0.95
    comparison = table(np.ones((4, 2)), shares)
    assert list(quiet_gaps(comparison, SHARE)) == [True, True, False, True]


def test_motions_that_escape_are_the_worst():
    worst = np.ones((5, 2))
    worst[3:] = np.inf
    comparison = table(worst, np.full((5, 2), 0.5))
    choice = choose(comparison, SHARE, 0.05)
    assert choice.kind == "least_worst" and choice.gap * 1.05 < comparison["candidate_gap"][3]


@pytest.mark.parametrize(
    ("least", "most", "gap"), [(6.0, 8.5, 7.14), (7.001, 7.004, 7.002), (7.0, 7.0, 7.0)]
)
def test_the_middle_of_a_range_has_no_more_digits_than_it_needs(least, most, gap):
    assert middle_gap(least, most) == gap


def test_buildable_gaps_have_three_digits():
    assert list(buildable(9.97, 10.2)) == [9.97, 9.98, 9.99, 10.0, 10.1, 10.2]
    assert buildable(1.0001, 1.0002) == pytest.approx([1.00015])
