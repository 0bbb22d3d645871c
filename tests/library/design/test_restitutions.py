"""Which of several restitutions is best."""

import pytest

from impact_damper.design.restitutions import best_of


@pytest.mark.parametrize(
    ("worst", "kinds", "best"),
    [
        ([1.0, 0.5, 0.8], [0, 0, 0], 1),
        ([1.0, 0.5, 0.8], [0, 1, 0], 2),
        ([1.0, 0.5, 0.8], [2, 2, 1], 2),
        ([float("inf"), 9.0], [2, 2], 1),
        ([0.5, 0.5], [0, 0], 0),
    ],
)
def test_the_kind_of_choice_counts_before_the_displacement(worst, kinds, best):
    assert best_of(worst, kinds) == best
