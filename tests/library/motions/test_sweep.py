"""Motions along a sweep: branches, ends, matching, and orbits that starts miss."""

import numpy as np
import pytest
from helpers.known_orbits import PAPER
from numpy.testing import assert_allclose

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.settling import Settling
from impact_damper.motions import start_states
from impact_damper.motions.records import MOTION
from impact_damper.motions.simulate import random_states
from impact_damper.motions.start_states import NO_LOOSE, NO_STARTS, Search
from impact_damper.motions.sweep import match_unsettled, sweep

FREQUENCIES = np.array([1.25, 1.4, 1.6, 1.75, 1.9, 2.0, 2.05, 2.1])


def random_search(states):
    """Return a search whose only starts are `states`."""
    return Search(
        states, [NO_STARTS] * len(states), [NO_LOOSE] * len(states), *np.zeros((4, len(states)))
    )


def free_sweep(frequencies, **options):
    parameters = np.array([pack(PAPER, None, w) for w in frequencies])
    states = np.array([random_states(12, 2.5, None, [2, i]) for i in range(len(frequencies))])
    return sweep(parameters, FREQUENCY, "frequency", random_search(states), Settling(), **options)


@pytest.fixture(scope="module")
def free():
    return free_sweep(FREQUENCIES, workers=2)


def ends_of(data, event="fold"):
    """Return parameter, direction and displacement of all ends of branches at the event `event`."""
    chosen = data["end_event"] == flag("end_event", event)
    columns = (data["end_value"], data["end_direction"], data["end_displacement"])
    return np.array(columns).T[chosen]


def test_three_branches_of_the_free_oscillator(free):
    """Resonance, non-resonance and one-third subharmonic motions are found, no other motions."""
    period, size = free["period"][1], free["maximum_displacement"][1]
    assert np.array_equal((period == 1).sum(axis=1), [1, 2, 2, 2, 2, 2, 1, 1])
    assert np.array_equal((period == 3).sum(axis=1), [0, 0, 0, 1, 1, 1, 1, 0])
    branch = free["branch"][1]
    for chosen in ((period == 3), (period == 1) & (size > 1.5), (period == 1) & (size < 0.9)):
        assert len(np.unique(branch[chosen])) == 1
    assert len(np.unique(branch[period > 0])) == 3


def test_branches_end_at_folds(free):
    """All branches end at folds, and the ends do not depend on the grid of the sweep."""
    ends = ends_of(free)
    assert len(ends) == 4 == len(free["end_value"])
    other = ends_of(free_sweep(np.array([1.28, 1.5, 1.8, 2.0, 2.03, 2.09])))
    order, again = np.argsort(ends[:, 0]), np.argsort(other[:, 0])
    assert_allclose(ends[order], other[again], atol=1e-4)
    assert np.array_equal(ends[order][:, 1], [-1, -1, 1, 1])


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


NEVER = np.zeros(1, bool)
# Oscillator, damper, frequency, (max |Z1|, period) of an orbit to which few random starts lead.
RARE = [
    (
        idm.Oscillator(0.11048, 1.0, cubic=0.0030857, force=0.32103),
        idm.Damper(0.042979, 3.38804, 0.99667, 2799.53),
        0.99966,
        (2.600, 1),
    ),
    (
        idm.Oscillator(0.066086, 1.0, cubic=-0.011362, force=0.068981),
        idm.Damper(0.076894, 1.25925, 0.76231, 11897.3),
        0.88489,
        (0.529, 3),
    ),
]


@pytest.mark.parametrize(("oscillator", "damper", "frequency", "rare"), RARE)
@pytest.mark.parametrize("seed", [1])
def test_a_search_finds_an_orbit_to_which_no_start_leads(
    oscillator, damper, frequency, rare, seed, monkeypatch
):
    monkeypatch.setattr(start_states, "_placed", lambda *_: start_states.NO_STARTS)
    found = idm.frequency_response(oscillator, damper, [frequency], starts=8, seed=seed)
    found = found.isel(frequency=0)
    size, period = rare
    (place,) = np.flatnonzero(
        (abs(found.maximum_displacement - size) < 2e-3) & (found.period == period)
    )
    one = found.isel(motion=place)
    assert one.origin == flag("origin", "followed") and one.motion_starts == 0
    # the integrator alone, without Newton's method, stays on the orbit
    run = idm.simulate(oscillator, damper, frequency, one.state, periods=20 * period)
    np.testing.assert_allclose(run.displacement[-1], run.displacement[0], atol=1e-6)
