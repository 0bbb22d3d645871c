"""Functions called with a machine, against the same functions called with numbers scaled by hand.

The machine is the paper's oscillator with lengths in units of 2 mm, times of 10 ms and masses of
3 kg. `Machine.scales` has other units.
"""

import math

import numpy as np
import pytest

import impact_damper as idm
from impact_damper.data.datasets import flag

LENGTH, TIME, MASS = 2e-3, 1e-2, 3.0
FORCE, STIFFNESS = MASS * LENGTH / TIME**2, MASS / TIME**2
PAPER, PAPER_DAMPER = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
HARD = idm.Machine(
    mass=MASS, cubic_stiffness=STIFFNESS / LENGTH**2, damping=0.215 * MASS / TIME, force=FORCE
)
DAMPER = HARD.damper(
    mass=0.12 * MASS, clearance_each_side=2 * LENGTH, contact_stiffness=2000 * STIFFNESS
)
SOFTENING = {
    "mass": MASS,
    "linear_stiffness": STIFFNESS,
    "cubic_stiffness": -STIFFNESS / LENGTH**2,
    "damping": 0.05 * MASS / TIME,
}
SOFT = idm.Machine(**SOFTENING, force=0.02 * FORCE)
LINEAR = idm.Machine(mass=MASS, linear_stiffness=STIFFNESS, damping_ratio=0.01, force=FORCE)
# The dimensionless 1 in each unit of the datasets of the machine.
UNITS = {
    "mm": 1e3 * LENGTH,
    "s": TIME,
    "Hz": 1 / (2 * math.pi * TIME),
    "1/s": 1 / TIME,
    "1": 1.0,
    "radian": 1.0,
}


def hertz(frequency):
    return frequency * UNITS["Hz"]


def assert_scaled(found, by_hand, names, **tolerances):
    """Assert that variables equal those of `by_hand`, times the unit that each variable states."""
    for name in names:
        expected = by_hand[name].values * UNITS[found[name].attrs.get("units", "1")]
        np.testing.assert_allclose(found[name], expected, err_msg=name, **tolerances)


def test_migration_of_a_machine():
    """The damper is on for 3 cycles only, so that chaos does not magnify rounding errors."""
    given = {"seed": 1, "longest_hold": 3}
    found = idm.migrate(HARD, DAMPER, hertz(1.95), **given)
    by_hand = idm.migrate(PAPER, PAPER_DAMPER, 1.95, **given)
    names = ("on_time", "off_time", "destination", "destination_displacement", "switchings")
    assert [found[name].attrs.get("units") for name in names[:4]] == ["s", "s", "1", "mm"]
    assert_scaled(found, by_hand, names, rtol=1e-6)
    short = {"time": slice(0, 1000)}
    assert_scaled(
        found.isel(short), by_hand.isel(short), ("time", "displacement"), rtol=1e-6, atol=1e-6
    )


def assert_same_basins(found, by_hand):
    np.testing.assert_array_equal(found["basin_label"], by_hand["basin_label"])
    names = ("basin_displacement", "attractor_displacement", "frequency", "attractor_share")
    assert [found[name].attrs["units"] for name in names] == ["mm", "mm", "Hz", "1"]
    assert_scaled(found, by_hand, (*names, "attractor_phase"), rtol=1e-6)
    assert found["basin_velocity"].attrs["units"] == "m/s"
    np.testing.assert_allclose(found["basin_velocity"], by_hand["basin_velocity"] * LENGTH / TIME)


@pytest.mark.thorough
def test_basins_of_a_machine():
    window = {"displacement": f"{3e3 * LENGTH} mm", "velocity": 4.5 * LENGTH / TIME}
    found = idm.basins(HARD, None, hertz(1.85), **window, cells=30)
    by_hand = idm.basins(PAPER, None, 1.85, displacement=3.0, velocity=4.5, cells=30)
    assert_same_basins(found, by_hand)
    assert_scaled(found, by_hand, ["saddle_displacement"], rtol=1e-6)
    assert found["attractor_speed"].attrs["units"] == "m/s"


def test_basins_of_a_machine_with_a_damper():
    """The loose mass has one state, near a motion in which no chaos magnifies rounding errors."""
    kept = {"restitution": 0.75, "contact_stiffness": 2000 * STIFFNESS}
    damper = HARD.damper(mass=0.25 * MASS, clearance_each_side=LENGTH, **kept)
    window = {"displacement": 0.2 * LENGTH, "velocity": 0.3 * LENGTH / TIME, "cells": 4}
    loose = [f"{500 * LENGTH} mm", -0.5 * LENGTH / TIME]
    found = idm.basins(HARD, damper, hertz(2.0), **window, loose=loose)
    window = {"displacement": 0.2, "velocity": 0.3, "cells": 4}
    inelastic = idm.Damper(0.25, 1.0, 0.75)
    by_hand = idm.basins(PAPER, inelastic, 2.0, **window, loose=[0.5, -0.5])
    assert by_hand["attractor_share"].sum() == 1
    assert_same_basins(found, by_hand)


def test_migration_of_a_softening_machine():
    """The resonance branch of a softening spring extends to high frequencies."""
    damper = SOFT.damper(
        mass=0.1 * MASS,
        clearance_each_side=0.4 * LENGTH,
        restitution=0.8,
        contact_stiffness=2000 * STIFFNESS,
    )
    found = idm.migrate(SOFT, damper, hertz(0.93), seed=1)
    assert int(found["trial_outcome"]) == flag("trial_outcome", "reached")
    free = idm.frequency_response(SOFT, None, [hertz(0.93)], starts=8)["maximum_displacement"]
    least, most = np.nanmin(free), np.nanmax(free)
    assert most > 2 * least
    assert float(found["destination_displacement"][-1]) == pytest.approx(least, rel=1e-6)
    assert float(found["displacement"][:100].max()) == pytest.approx(most, rel=1e-2)


def test_the_radius_of_a_search_is_warned_of_in_si_units():
    expected = r"^radius = 1e-5 m: .* at frequency = 31 Hz, with displacement = 0\.00\d+ m and"
    with pytest.warns(UserWarning, match=expected):
        idm.frequency_response(HARD, None, [31], starts=1, radius="10 µm")


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (
            lambda: idm.migrate(HARD, DAMPER, 40.0),
            "frequency = 40 Hz: without the damper there must be both a non-resonance and a res",
        ),
        (lambda: idm.migrate(LINEAR, DAMPER, 16.0), "frequency = 16 Hz: without the damper there"),
        (
            lambda: idm.frequency_response(LINEAR, DAMPER, [16, 15.5]),
            "frequencies = [16, 15.5]: must be increasing",
        ),
        (
            lambda: idm.basins(LINEAR, None, 16, displacement="-1 mm"),
            "displacement = '-1 mm': must be greater than 0 m and at most",
        ),
        (
            lambda: idm.basins(HARD, DAMPER, 16, loose=["1 mm", "1 mm"]),
            "loose[1] = '1 mm': must be a number in m/s, or text",
        ),
        (
            lambda: idm.basins(HARD, DAMPER, 16, loose=0),
            "loose = 0: must be two numbers, displacement and velocity",
        ),
    ],
)
def test_what_makes_no_sense_is_said_in_si_units(call, told):
    with pytest.raises((TypeError, ValueError)) as raised:
        call()
    assert str(raised.value).startswith(told)
