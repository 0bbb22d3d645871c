"""Functions called with a machine, against the same calls with numbers scaled by hand."""

import math

import numpy as np
import pytest

import impact_damper as idm
from impact_damper.theory.design_rule import rule_clearance

LENGTH, TIME, MASS = 2e-3, 1e-2, 3.0
FORCE, STIFFNESS = MASS * LENGTH / TIME**2, MASS / TIME**2
PAPER, PAPER_DAMPER = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
HARD = idm.Machine(
    mass=MASS, cubic_stiffness=STIFFNESS / LENGTH**2, damping=0.215 * MASS / TIME, force=FORCE
)
DAMPER = HARD.damper(
    mass=0.12 * MASS, clearance_each_side=2 * LENGTH, contact_stiffness=2000 * STIFFNESS
)
SOFTENING = idm.Machine(
    mass=MASS,
    linear_stiffness=STIFFNESS,
    cubic_stiffness=-STIFFNESS / LENGTH**2,
    damping=0.05 * MASS / TIME,
    force="8 N",
)
# The dimensionless 1 in each unit of the datasets of the machine.
UNITS = {
    "mm": 1e3 * LENGTH,
    "s": TIME,
    "Hz": 1 / (2 * math.pi * TIME),
    "m/s": LENGTH / TIME,
    "1": 1.0,
    "radian": 1.0,
}


def assert_scaled(found, by_hand, names, **tolerances):
    """Assert that variables equal those of `by_hand`, times the unit that each variable states."""
    for name in names:
        expected = by_hand[name].values * UNITS[found[name].attrs.get("units", "1")]
        np.testing.assert_allclose(found[name], expected, err_msg=name, **tolerances)


def test_migration_of_a_machine():
    """The damper is on for 3 cycles only, so that chaos does not magnify rounding errors."""
    given = {"seed": 1, "longest_hold": 3}
    found = idm.migrate(HARD, DAMPER, 1.95 * UNITS["Hz"], **given)
    by_hand = idm.migrate(PAPER, PAPER_DAMPER, 1.95, **given)
    names = ("on_time", "off_time", "destination", "switchings")
    assert [found[name].attrs.get("units") for name in names[:3]] == ["s", "s", "1"]
    assert_scaled(found, by_hand, names, rtol=1e-6)
    short = {"time": slice(0, 1000)}
    assert_scaled(
        found.isel(short), by_hand.isel(short), ("time", "displacement"), rtol=1e-6, atol=1e-6
    )


def test_basins_of_a_machine_with_a_damper():
    """The loose mass has one state, near a motion in which no chaos magnifies rounding errors."""
    kept = {"restitution": 0.75, "contact_stiffness": 2000 * STIFFNESS}
    damper = HARD.damper(mass=0.25 * MASS, clearance_each_side=LENGTH, **kept)
    window = {"displacement": 0.2 * LENGTH, "velocity": 0.3 * LENGTH / TIME, "cells": 4}
    loose = [f"{500 * LENGTH} mm", -0.5 * LENGTH / TIME]
    found = idm.basins(HARD, damper, 2.0 * UNITS["Hz"], **window, loose=loose)
    window = {"displacement": 0.2, "velocity": 0.3, "cells": 4}
    inelastic = idm.Damper(0.25, 1.0, 0.75)
    by_hand = idm.basins(PAPER, inelastic, 2.0, **window, loose=[0.5, -0.5])
    assert by_hand["attractor_share"].sum() == 1
    np.testing.assert_array_equal(found["basin_label"], by_hand["basin_label"])
    names = ("basin_displacement", "attractor_displacement", "frequency", "basin_velocity")
    assert [found[name].attrs["units"] for name in names] == ["mm", "mm", "Hz", "m/s"]
    assert_scaled(found, by_hand, names, rtol=1e-6)


def test_the_radius_of_a_search_is_warned_of_in_si_units():
    expected = r"^radius = 1e-5 m: .* at frequency = 31 Hz, with displacement = 0\.00\d+ m and"
    with pytest.warns(UserWarning, match=expected):
        idm.frequency_response(HARD, None, [31], starts=1, radius="10 µm")


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda d: idm.simulate(HARD, d, 0), "frequency = 0 Hz: must be at least"),
        (lambda d: idm.simulate(HARD, d, 20, ("1 kg", 0, 0, 0)), "state[0] = '1 kg': must be"),
        (lambda d: idm.frequency_response(HARD, d, [20, "0 Hz"]), "frequencies[1] = '0 Hz': must"),
        (
            lambda d: idm.basins(HARD, d, 16, loose=["1 mm", "1 mm"]),
            "loose[1] = '1 mm': must be a number in m/s, or text",
        ),
        (
            lambda d: idm.migrate(HARD, d, 40.0),
            "frequency = 40 Hz: without the damper there must be both a non-resonance and a res",
        ),
        (
            lambda d: rule_clearance(SOFTENING.oscillator(), 0.1),
            "force = 8 N: the response has no peak, the motion goes over the barrier of the "
            "softening spring (cubic_stiffness = -7.5e9 N/m^3)",
        ),
    ],
)
def test_wrong_arguments_are_named_in_si_units(call, told):
    with pytest.raises((TypeError, ValueError)) as raised:
        call(DAMPER)
    assert str(raised.value).startswith(told)
