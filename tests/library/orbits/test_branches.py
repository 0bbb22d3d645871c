"""Branches of orbits: closed forms, simulation on both sides of events, ends, and symmetry."""

from dataclasses import replace

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER, polished_orbit
from numpy.testing import assert_allclose

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper
from impact_damper.model.settling import Settling
from impact_damper.motions.ensemble import settle
from impact_damper.motions.following import follow_stable
from impact_damper.motions.response import frequency_response
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit_branches import orbit_branches, periodic_orbit
from impact_damper.orbits.shooting import find_orbit

SETTLING = Settling(tolerance=1e-10, patience=300, limit=3000)


def free(value):
    return pack(PAPER, None, value)


def damped(value):
    return pack(PAPER, DESIGN, value)


@pytest.fixture(scope="module")
def resonance():
    orbit = find_orbit(free(2.0), polished_orbit("resonance").state)
    return follow_branch(free, orbit, 2.0, (0.6, 2.6))


@pytest.fixture(scope="module")
def quiet():
    orbit = find_orbit(damped(2.0), polished_orbit("design").state)
    return follow_branch(damped, orbit, 2.0, (0.6, 2.6))


def event(branch, kind, number=0):
    """Return the point of a branch at an event, given by its kind and its number in this kind."""
    return [event for _, event in branch.events if event.kind == kind][number].point


def test_every_orbit_is_exact(quiet, resonance):
    for branch in (quiet, resonance):
        for point in branch.points:
            assert point.orbit.converged and point.orbit.liouville_error < 1e-10
            assert point.orbit.p[0] == point.value


def test_fold_by_simulation_on_both_sides(resonance):
    """The resonance motion exists just below the frequency of the upper fold, but not above it."""
    fold = event(resonance, "fold")
    p = free(fold.value - 1e-4)
    below = [point for point in resonance.points if point.orbit.stable and point.value < fold.value]
    nearest = max(below, key=lambda point: point.value)
    y, at = nearest.orbit.strobe_states[0].copy(), nearest.orbit.p.copy()
    at, (y, _) = follow_stable(at, y, 1, FREQUENCY, p[FREQUENCY])
    assert at[FREQUENCY] == p[FREQUENCY]
    record = settle(p[None], y[None] + 1e-6, SETTLING, from_strobe=True)[0]
    assert record["maximum_displacement"] > 2.3
    beyond = settle(free(fold.value + 1e-4)[None], y[None], SETTLING, from_strobe=True)[0]
    assert beyond["maximum_displacement"] < 1


def test_symmetry_is_lost_where_simulation_loses_it(resonance):
    lost = event(resonance, "symmetry_breaking")
    for side, symmetric in ((1e-3, True), (-1e-3, False)):
        p = free(lost.value + side)
        nudged = lost.orbit.strobe_states[0] + np.array([1e-3, 0, 1e-3, 0])
        record = settle(p[None], nudged[None], SETTLING, from_strobe=True)[0]
        assert (record["asymmetry"] < 1e-6) == symmetric


def test_period_doubles_where_simulation_doubles_it():
    """The large motion has period 1 above the frequency of the event and period 2 below."""
    orbit = find_orbit(damped(1.7), polished_orbit("large").state)
    branch = follow_branch(damped, orbit, 1.7, (1.58, 1.8))
    doubling = event(branch, "period_doubling")
    for side, period in ((2e-3, 1), (-2e-3, 2)):
        p = damped(doubling.value + side)
        nudged = doubling.orbit.strobe_states[0] + np.array([1e-3, 0, 1e-3, 0])
        record = settle(p[None], nudged[None], SETTLING, from_strobe=True)[0]
        assert (record["outcome"], record["period"]) == (1, period)


def test_quiet_motion_folds_into_the_unstable_large_one(quiet):
    """The quiet motion and the unstable large motion lie on one branch."""
    assert quiet.ends == ("range_ends", "range_ends") and quiet.lost == 0
    assert all(point.orbit.sequence == "+-" for point in quiet.points)
    assert_allclose(
        min(point.value for point in quiet.points if point.orbit.stable),
        min(found.point.value for _, found in quiet.events if found.kind == "fold"),
        atol=1e-5,
    )
    large = max(quiet.points, key=lambda point: point.orbit.record["maximum_displacement"])
    assert not large.orbit.stable


def test_isola_is_closed():
    """The branch of the one-third subharmonic, a motion of period 3, is a closed curve."""
    response = frequency_response(PAPER, None, [1.8], starts=96)
    branches = orbit_branches(PAPER, None, span=(0.6, 2.6), motions=[response])
    third = int(np.flatnonzero(branches["branch_period"].values == 3)[0])
    assert branches["branch_end"].values[third].tolist() == [1, 1]
    points = branches.isel(point=np.flatnonzero(branches["orbit_branch"].values == third))
    assert_allclose(points["followed_value"][0], points["followed_value"][-1])
    assert_allclose(points["orbit_displacement"][0], points["orbit_displacement"][-1], atol=1e-8)
    assert branches["seeds_lost"] == 0
    assert np.all(points["orbit_asymmetry"] < 1e-8)
    stable = points["orbit_stability"].values == 1
    values = points["followed_value"].values
    assert_allclose(values[stable].max(), values.max(), atol=1e-4)
    assert not stable.all() and points["orbit_residual"].max() < 2e-12


def test_a_branch_holds_its_orbits_and_no_others(quiet, resonance):
    for branch in (quiet, resonance):
        middle = branch.points[len(branch.points) // 3]
        orbit = find_orbit(middle.orbit.p, middle.orbit.strobe_states[0])
        assert branch.holds(orbit, middle.value)
        assert not branch.holds(orbit, middle.value + 0.01)
    other = find_orbit(free(1.9), polished_orbit("non-resonance").state)
    assert not quiet.holds(other, 1.9)
    of_period_2 = replace(quiet.points[5].orbit, periods=2)
    assert not quiet.holds(of_period_2, quiet.points[5].value)


@pytest.mark.parametrize(
    ("parameter", "span"),
    [
        ("clearance", (1.5, 2.5)),
        ("mass_ratio", (0.05, 0.2)),
        ("restitution", (0.8, 1.0)),
        ("damping", (0.1, 0.4)),
        ("contact_stiffness", (1e3, 1e5)),
    ],
)
def test_branches_over_each_parameter_end_on_an_orbit(parameter, span):
    """The first and the last orbit are those that Newton's method finds at the ends of the span."""
    state = polished_orbit("design").state
    branch = orbit_branches(PAPER, DESIGN, 2.0, state, parameter=parameter, span=span)
    values = branch["followed_value"].values
    assert_allclose([values.min(), values.max()], span, rtol=1e-12)
    for row in (0, -1):
        oscillator, damper = PAPER, DESIGN
        if parameter == "damping":
            oscillator = replace(PAPER, damping=values[row])
        else:
            damper = replace(DESIGN, **{parameter: min(values[row], span[1])})
        found = periodic_orbit(
            oscillator,
            damper,
            2.0,
            branch["orbit_state"].values[row],
            phase=float(branch["orbit_phase"][row]),
        )
        assert_allclose(found["orbit_displacement"], branch["orbit_displacement"][row], rtol=1e-9)
        assert_allclose(
            found["orbit_multiplier_real"][0],
            branch["orbit_multiplier_real"].values[row],
            atol=1e-7,
        )


@pytest.mark.parametrize(
    ("parameter", "side", "bound"), [("contact_stiffness", 1, 1e9), ("damping", 0, 1e-9)]
)
def test_a_branch_ends_at_a_bound_of_its_parameter(parameter, side, bound):
    span = (1.0, bound) if side else (bound, 1.0)
    state = polished_orbit("inelastic").state
    branch = orbit_branches(PAPER, INELASTIC, 2.0, state, parameter=parameter, span=span)
    ends = branch["followed_value"].values[[0, -1]]
    assert_allclose(ends[np.argmax(ends) if side else np.argmin(ends)], bound, rtol=1e-12)
    assert branch["branch_end"].values.tolist() == [[0, 0]]


@pytest.fixture(scope="module")
def grazing():
    """Return a damper, its branches, and the events at which the sequence of contacts changes."""
    soft = Damper(0.4, 0.625, contact_stiffness=50.0)
    response = frequency_response(PAPER, soft, [1.2, 1.4, 2.0], starts=24)
    branches = orbit_branches(PAPER, soft, span=(0.9, 2.6), motions=[response])
    changes = np.flatnonzero(np.isin(branches["event_kind"].values, [5, 6]))
    assert len(changes) > 0
    return soft, branches, changes


@pytest.mark.thorough
def test_change_of_contacts_is_where_a_contact_has_no_speed(grazing):
    _, branches, changes = grazing
    for k in changes:
        assert branches["walls_before"].values[k] != branches["walls_after"].values[k]
        assert branches["event_speed"].values[k] < 1e-4, branches["event_kind"].values[k]


def test_bad_arguments_are_named():
    state = polished_orbit("design").state
    with pytest.raises(ValueError, match="parameter = 'gap'.*clearance"):
        orbit_branches(PAPER, DESIGN, 2.0, state, parameter="gap", span=(1, 3))
    with pytest.raises(ValueError, match="no damper to change"):
        orbit_branches(PAPER, None, 2.0, (0, 0.5), parameter="clearance", span=(1, 3))
    with pytest.raises(ValueError, match="must hold clearance = 2"):
        orbit_branches(PAPER, DESIGN, 2.0, state, parameter="clearance", span=(3, 4))
    with pytest.raises(ArithmeticError, match="residual"):
        periodic_orbit(PAPER, Damper(0.12, 2.0), 2.0, (3.0, 9.0, 0.0, 30.0), period=5)
