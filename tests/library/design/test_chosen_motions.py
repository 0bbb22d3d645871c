"""Motions with a chosen damper. A motion in which no wall is touched is reported separately."""

import numpy as np
import pytest
from helpers.design_tasks import task

import impact_damper as idm
from impact_damper.design.chosen_motions import reached_motions
from impact_damper.design.costs import measured_costs
from impact_damper.design.task import labelled
from impact_damper.motions.response import frequency_response
from impact_damper.motions.strobe_map import strobe_time

RATIO, BASE, GAP, LIMIT = 0.01, 2e-4, 18.3, 4.6
MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=RATIO, base_displacement=BASE)
TASK = task(
    machine=MACHINE, mass=0.24, band=(20.4, 20.7), restitution=0.5, frequencies=3, starts=73
)


def test_a_motion_within_the_gap_is_not_counted_as_reached():
    """At frequencies at which the machine alone moves less than half the gap, no wall is touched.

    A loose mass at rest in the middle of the gap then stays at rest.
    """
    damper = TASK.damper(1e-3 * GAP)
    response = frequency_response(MACHINE, damper, TASK.grid, starts=73)
    choice = labelled({"design_gap": GAP})
    found = reached_motions(TASK, choice, response)
    r = TASK.grid / MACHINE.natural_frequency
    bare = 1e3 * BASE * r**2 / np.hypot(1 - r**2, 2 * RATIO * r)  # relative to the base
    inside = bare < GAP / 2
    assert list(inside) == [True, False, True]
    expected = np.where(inside, bare, np.nan)
    assert found["untouched_displacement"].values == pytest.approx(expected, rel=1e-6, nan_ok=True)
    assert (found["reached_displacement"] < LIMIT).all()
    assert (found["impact_rate_by_frequency"] > 1.9 * TASK.grid).all()


def test_a_machine_on_a_moving_base_without_contacts_in_absolute_coordinates():
    """If no wall is touched, the linear machine moves alone, and its transmission is known."""
    frequency, wide = 19.0, 60.0
    p = TASK.packed(1e-3 * wide, frequency)
    steady = idm.steady_motion(MACHINE, None, frequency)
    units = [MACHINE.scales.unit(each) for each in ("displacement", "velocity")] * 2
    state = steady["state"].values / units * (1, 1, 0, 0)
    state[2:] = state[:2]
    found = measured_costs(p, state, strobe_time(p), 5)
    r = frequency / MACHINE.natural_frequency
    moved = BASE * np.hypot(1, 2 * RATIO * r) / np.hypot(1 - r**2, 2 * RATIO * r)
    length = MACHINE.scales.unit("displacement") * found["absolute_displacement"]
    assert length == pytest.approx(moved, rel=1e-7)
    fast = MACHINE.scales.unit("acceleration") * found["largest_acceleration"]
    assert fast == pytest.approx((2 * np.pi * frequency) ** 2 * moved, rel=1e-7)
