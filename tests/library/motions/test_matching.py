"""Matching of motions that have not settled, against motions whose identity is known."""

import numpy as np
import pytest
from helpers.known_orbits import PAPER

from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper
from impact_damper.motions.records import MOTION
from impact_damper.motions.response import frequency_response
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


def test_a_motion_is_matched_once():
    pairs = match_unsettled(CHAOS[:1], [motion("chaotic", size) for size in (1.9, 2.0, 2.1)])
    assert pairs == [(0, 1)]


@pytest.mark.parametrize(
    "other",
    [
        motion("chaotic", 0.2),
        motion("quasi_periodic", 0.1),
        motion("settled", 0.1),
        motion("chaotic", 0.1, period=2),
    ],
)
def test_other_kinds_and_sizes_are_other_motions(other):
    assert match_unsettled([CHAOS[2]], [other]) == []


@pytest.mark.parametrize(("outcome", "size"), [("at_rest", 0.0), ("escaped", np.inf)])
def test_motions_without_a_finite_size(outcome, size):
    assert match_unsettled([motion(outcome, size)], [motion(outcome, size)]) == [(0, 0)]


def test_chaos_that_is_small_for_a_while_is_the_same():
    """The field `reach` is compared too, because chaos may be small while it is measured."""
    small = motion("chaotic", 2.1)
    small["maximum_displacement"] = 0.3
    assert match_unsettled(CHAOS, [small]) == [(0, 0)]


def test_chaos_of_one_damper_is_one_motion():
    """Between bursts the loose mass rests for many periods, so one chaos has records that differ.

    Their displacements were measured with and without a burst.
    """
    found = frequency_response(PAPER, Damper(0.12, 2.0), [2.6], starts=60, radius=2.0, seed=1)
    chaos = found.outcome.values[0] == flag("outcome", "chaotic")
    assert chaos.sum() == 1 and int(found.motion_starts.values[0][chaos][0]) > 20


def test_settled_motions_are_followed_instead():
    assert match_unsettled([motion("settled", 1.0, 1)], [motion("settled", 1.0, 1)]) == []


@pytest.mark.thorough
def test_a_torus_keeps_its_number():
    """At each frequency there is one quasi-periodic motion, and all lie on one branch."""
    found = frequency_response(PAPER, Damper(0.25, 1.0, 0.75), [1.45, 1.5, 1.55], starts=40)
    torus = (found.outcome == flag("outcome", "quasi_periodic")).values
    assert np.all(torus.sum(axis=1) == 1)
    assert len(np.unique(found.branch.values[torus])) == 1
    # no two motions at one frequency have the same branch number
    for row in found.branch.values:
        assert len(np.unique(row[row >= 0])) == np.sum(row >= 0)
