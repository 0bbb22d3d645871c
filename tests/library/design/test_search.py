"""The choice among gaps on made-up curves whose best gap is known."""

import numpy as np
import pytest
from helpers.design_tasks import task

from impact_damper.design.search import Curve, middle_gap


def curve(sizes, tolerance, gaps=None):
    """Return a curve with displacements given as a function of the gap (mm)."""
    made = Curve(task(tolerances={"gap": tolerance}))
    gaps = np.geomspace(1, 20, 200) if gaps is None else np.asarray(gaps, float)
    made.put(gaps, np.vectorize(sizes)(gaps), np.full(len(gaps), 20.5))
    return made


def valleys(gap):
    """Return the displacement: 2 mm at gaps of 4 to 6 mm, 1.95 mm at 9 to 9.5 mm, else 10 mm."""
    return 2.0 if 4 <= gap <= 6 else 1.95 if 9 <= gap <= 9.5 else 10.0


def test_the_widest_of_equally_good_ranges_is_chosen_in_its_middle():
    found = curve(valleys, 0.02).choose()
    assert found.gap == pytest.approx(np.sqrt(4 * 6), rel=0.03)
    assert found.low == pytest.approx(4 / 0.98, rel=0.02)
    assert found.high == pytest.approx(6 / 1.02, rel=0.02)
    assert found.size == pytest.approx(2.0)


def test_a_range_that_is_much_better_is_chosen_though_it_is_narrow():
    found = curve(lambda gap: 1.0 if 9 <= gap <= 9.5 else valleys(gap), 0.01).choose()
    assert 9 <= 0.99 * found.gap and 1.01 * found.gap <= 9.5


def test_a_tolerance_wider_than_a_range_leads_to_another_one():
    assert 4 / 0.9 <= curve(valleys, 0.1).choose().gap <= 6 / 1.1


def test_the_least_displacement_next_to_a_cliff_is_not_chosen():
    """The displacement falls up to a cliff at 8 mm. Gaps within the tolerance lie below 8 mm."""
    found = curve(lambda gap: 4 - gap / 4 if gap < 8 else 15.0, 0.05)
    choice = found.choose()
    assert 1.05 * choice.gap < 8
    nominal, values = found.nominal()
    best = np.interp(choice.gap, nominal, values)
    assert best <= 1.06 * values.min()
    gaps, sizes = found.lost(choice.gap, 1.1 * best)
    assert 8 <= gaps[1] < 8.2 and sizes[1] == 15


def test_the_value_of_a_nominal_gap_is_the_largest_within_the_tolerance():
    """The values are compared with a brute force over many gaps."""

    def waves(gap):
        return 3 + np.sin(7 * np.log(gap)) + 0.3 * np.sin(31 * np.log(gap))

    made = curve(waves, 0.07)
    nominal, values = made.nominal()
    for gap, value in zip(nominal[::400], values[::400], strict=True):
        assert value == pytest.approx(waves(gap * np.linspace(0.93, 1.07, 2001)).max(), rel=4e-3)


def test_cliffs_and_small_displacements_are_refined():
    made = curve(valleys, 0.02, np.geomspace(1, 20, 30))
    for _ in range(12):
        gaps = made.unclear()[:8]
        made.put(gaps, np.vectorize(valleys, otypes=[float])(gaps), np.full(len(gaps), 20.5))
    for cliff in (4, 6):
        assert np.abs(made.gaps / cliff - 1).min() < 0.004
    assert len(made.gaps) < 100


@pytest.mark.parametrize(
    ("ends", "gap"), [((7.664, 8.167), 7.91), ((14.76, 14.84), 14.8), ((1.00012, 1.00018), 1.00015)]
)
def test_a_gap_has_few_digits_and_lies_inside_its_range(ends, gap):
    assert middle_gap(*ends) == pytest.approx(gap, rel=1e-12)
