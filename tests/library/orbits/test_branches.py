"""Branches of orbits: closed forms, simulations on both sides of events, ends, symmetry."""

from dataclasses import replace

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER, polished_orbit
from numpy.testing import assert_allclose

from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper
from impact_damper.model.settling import Settling
from impact_damper.motions.ensemble import settle
from impact_damper.motions.response import frequency_response
from impact_damper.motions.simulate import simulate
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit_branches import orbit_branches, periodic_orbit
from impact_damper.orbits.shooting import find_orbit

SETTLING = Settling(tolerance=1e-10, patience=300, limit=3000)


def free(value):
    return pack(PAPER, None, value)


def damped(value):
    return pack(PAPER, DESIGN, value)


def test_period_doubles_where_simulation_doubles_it():
    """The large motion has period 1 above the frequency of the event and period 2 below."""
    orbit = find_orbit(damped(1.7), polished_orbit("large").state)
    branch = follow_branch(damped, orbit, 1.7, (1.58, 1.8))
    doubling = next(each.point for _, each in branch.events if each.kind == "period_doubling")
    for side, period in ((2e-3, 1), (-2e-3, 2)):
        p = damped(doubling.value + side)
        nudged = doubling.orbit.strobe_states[0] + np.array([1e-3, 0, 1e-3, 0])
        record = settle(p[None], nudged[None], SETTLING, from_strobe=True)[0]
        assert (record["outcome"], record["period"]) == (1, period)


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


@pytest.mark.parametrize(
    ("parameter", "span"),
    [
        ("clearance", (1.5, 2.5)),
        ("mass_ratio", (0.05, 0.2)),
        ("restitution", (0.8, 1.0)),
        ("contact_stiffness", (1e3, 1e5)),
    ],
)
def test_branches_over_each_parameter_end_on_an_orbit(parameter, span):
    """The motions from the first and the last orbit, at the ends of the span, repeat."""
    state = polished_orbit("design").state
    branch = orbit_branches(PAPER, DESIGN, 2.0, state, parameter=parameter, span=span)
    values = branch["followed_value"].values
    assert_allclose([values.min(), values.max()], span, rtol=1e-12)
    for row in (0, -1):
        damper = replace(DESIGN, **{parameter: min(values[row], span[1])})
        first, begin = branch["orbit_state"].values[row], float(branch["orbit_phase"][row]) / 2.0
        run = simulate(PAPER, damper, 2.0, first, start=begin, periods=1)
        assert_allclose([run[name][-1] for name in list(run)[:4]], first, atol=1e-7)


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
