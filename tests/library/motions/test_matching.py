"""Matching of motions that have not settled, against motions whose identity is known."""

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.motions.records import MOTION
from impact_damper.motions.sweep import match_unsettled


def motion(outcome, size, period=0):
    record = np.zeros(1, MOTION)[0]
    record["outcome"], record["period"] = flag("outcome", outcome), period
    record["maximum_displacement"] = record["reach"] = size
    return record


CHAOS = [motion("chaotic", size) for size in (2.0, 1.0, 0.1)]


def test_the_closest_sizes_are_matched_first():
    """With ratios below 1.5 the size 1.2 can only match 1.0; the size 1.45 can match 2.0 or 1.0."""
    assert match_unsettled(CHAOS, [motion("chaotic", size) for size in (1.45, 1.2)]) == [
        (1, 1),
        (0, 0),
    ]


def test_other_kinds_and_sizes_are_other_motions():
    others = [motion("chaotic", 0.2), motion("quasi_periodic", 0.1), motion("settled", 0.1)]
    assert match_unsettled([CHAOS[2]], [*others, motion("chaotic", 0.1, period=2)]) == []


def test_chaos_that_is_small_for_a_while_is_the_same():
    """The field `reach` is compared too, because chaos may be small while it is measured."""
    small = motion("chaotic", 2.1)
    small["maximum_displacement"] = 0.3
    assert match_unsettled(CHAOS, [small]) == [(0, 0)]
