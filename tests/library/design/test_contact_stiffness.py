"""The linear stiffness that replaces Hertz's contact, in the motion with this stiffness."""

from dataclasses import replace

import numpy as np
import pytest

import impact_damper as idm
from impact_damper.data.datasets import flag

MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
DAMPER = MACHINE.damper(mass=0.6, gap="8 mm", restitution=0.7, contact_stiffness=2e7)
BALL = idm.HertzContact("20 mm", idm.Material("210 GPa", 0.3))


def test_a_contact_after_hertz_agrees_with_its_motion():
    soft = replace(DAMPER, contact_stiffness=None, contact=BALL)
    frequency = MACHINE.natural_frequency
    found = idm.hertz_stiffness(MACHINE, soft, frequency)
    assert int(found["hertz_status"]) == flag("hertz_status", "consistent")
    # The motion with this stiffness is computed again.
    linear = replace(DAMPER, contact_stiffness=float(found["hertz_stiffness"]))
    steady = idm.steady_motion(MACHINE, linear, frequency)
    run = idm.periodic_orbit(
        MACHINE, linear, frequency, steady["state"].values, period=int(steady["period"])
    )
    speed = float(np.abs(run["approach_velocity"]).max())
    assert float(found["impact_speed"]) == pytest.approx(speed, rel=1e-5)
    mass = 12 * 0.6 / 12.6
    deepest = (5 * mass * speed**2 / (4 * BALL.coefficient)) ** 0.4
    assert float(found["impact_compression"]) == pytest.approx(1e3 * deepest, rel=1e-5)
    stiffness = mass * speed**2 / deepest**2
    assert float(found["hertz_stiffness"]) == pytest.approx(stiffness, rel=1e-4)


def test_a_loose_mass_that_touches_no_wall_has_no_stiffness():
    wide = replace(DAMPER, gap=0.05, contact_stiffness=None, contact=BALL)
    found = idm.hertz_stiffness(MACHINE, wide, 5.0)
    assert int(found["hertz_status"]) == flag("hertz_status", "no_contact")
    assert np.isnan(found["hertz_stiffness"])


def test_functions_ask_for_the_stiffness_of_a_contact_after_hertz():
    soft = replace(DAMPER, contact_stiffness=None, contact=BALL)
    with pytest.raises(ValueError, match=r"^contact = HertzContact.*: must be a contact_stiffness"):
        idm.simulate(MACHINE, soft, 20.0)
