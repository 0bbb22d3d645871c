"""Choice of a gap from a table of outcomes, against brute force.

A start is an initial state.
"""

import numpy as np
import pytest

from impact_damper.design.choose import Comparison, buildable, middle_gap, runs_of

FREQUENCIES = np.array([20.0, 21.0])


def table(worst, shares):
    """Comparison over gaps of 1 to 4 mm; the confidence interval of a share ends at the share."""
    shares = np.asarray(shares, float)
    numbers = {
        "worst_displacement": np.asarray(worst, float),
        "start_quiet_share": shares,
        "start_quiet_interval": np.stack([shares - 0.04, shares], axis=-1),
    }
    return Comparison(np.geomspace(1, 4, len(shares)), FREQUENCIES, numbers, 2.0, 0.95)


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
    gaps = comparison.gaps
    low, high = gap * (1 - tolerance), gap * (1 + tolerance)
    # Displacement and share are interpolated, so they are largest at an end or at a compared gap.
    tried = np.log([low, *gaps[(gaps > low) & (gaps < high)], high])
    worst = np.exp(np.interp(tried, np.log(gaps), np.log(comparison.worst))).max()
    shares = comparison.numbers["start_quiet_share"].mean(axis=1)
    loud = np.interp(tried, np.log(gaps), 1 - shares).max()
    quiet = low >= gaps[0] and high <= gaps[-1]
    quiet &= comparison.quiet[(gaps >= low) & (gaps <= high)].all()
    for k in range(len(gaps) - 1):
        if low < gaps[k + 1] and high > gaps[k]:
            quiet &= comparison.quiet[k : k + 2].all()
    return worst, quiet, loud


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("share", [0.9, 0.4, 0.0])
@pytest.mark.parametrize("tolerance", [0.0, 0.08, 0.2])
def test_the_choice_is_that_of_brute_force(seed, share, tolerance):
    comparison = made_up(seed, share)
    choice = comparison.choose(tolerance)
    coarse = buildable(1, 4)
    found = [judged(comparison, gap, tolerance) for gap in coarse]
    worst, quiet, loud = map(np.array, zip(*found, strict=True))
    here = judged(comparison, choice.gap, tolerance)
    if choice.kind == "robust":
        assert here[1] and here[0] <= worst[quiet].min() * 1.0011
        return
    assert not quiet.any()
    if choice.kind == "needs_tolerance":
        begins, ends = runs_of(comparison.quiet)
        ranges = np.log(comparison.gaps[ends] / comparison.gaps[begins])
        first, last = (comparison.gaps[each[np.argmax(ranges)]] for each in (begins, ends))
        assert any(
            comparison.gaps[a] <= choice.gap <= comparison.gaps[b]
            for a, b, width in zip(begins, ends, ranges, strict=True)
            if width >= np.log(last / first) - 2e-3
        )
        return
    assert not comparison.quiet.any()
    covered = (coarse * (1 - tolerance) >= 1) & (coarse * (1 + tolerance) <= 4)
    assert here[2] <= loud[covered].min() + 0.0011


def test_a_narrow_quiet_range_needs_a_closer_tolerance():
    shares = np.ones((9, 2))
    shares[[0, 1, 2, 5, 6, 7, 8], 1] = 0.5
    comparison = table(np.ones((9, 2)), shares)
    assert comparison.choose(0.2).kind == "needs_tolerance"
    assert comparison.gaps[3] <= comparison.choose(0.2).gap <= comparison.gaps[4]
    assert comparison.choose(0.05).kind == "robust"


def test_gaps_left_out_are_not_chosen_again():
    shares = np.full((9, 2), 0.5)
    shares[[1, 5, 6]] = 1
    comparison = table(np.ones((9, 2)), shares)
    gaps = comparison.gaps
    assert gaps[5] <= comparison.choose(0.2).gap <= gaps[6]
    fewer = comparison.without(gaps[5], gaps[6])
    assert list(fewer.gaps) == [*gaps[:5], *gaps[7:]]
    assert fewer.choose(0.2) == (pytest.approx(gaps[1], rel=1e-3), "needs_tolerance")
    assert fewer.without(gaps[1], gaps[1]).choose(0.2).kind == "least_worst"


def test_one_loud_frequency_makes_a_gap_loud():
    shares = np.ones((4, 2))
    shares[2, 1] = 0.98  # its confidence interval, from 0.94, reaches below the required 0.95
    comparison = table(np.ones((4, 2)), shares)
    assert list(comparison.quiet) == [True, True, False, True]


def test_motions_that_escape_are_the_worst():
    worst = np.ones((5, 2))
    worst[3:] = np.inf
    comparison = table(worst, np.full((5, 2), 0.5))
    choice = comparison.choose(0.05)
    assert choice.kind == "least_worst" and choice.gap * 1.05 < comparison.gaps[3]


@pytest.mark.parametrize(
    ("least", "most", "gap"), [(6.0, 8.5, 7.14), (7.001, 7.004, 7.002), (7.0, 7.0, 7.0)]
)
def test_the_middle_of_a_range_has_no_more_digits_than_it_needs(least, most, gap):
    assert middle_gap(least, most) == gap


def test_buildable_gaps_have_three_digits():
    assert list(buildable(9.97, 10.2)) == [9.97, 9.98, 9.99, 10.0, 10.1, 10.2]
    assert buildable(1.0001, 1.0002) == pytest.approx([1.00015])
