"""A machine with its damper in SI units: over the frequency, over the gap, and after Hertz."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.data.variables import VARIABLES
from impact_damper.stages.machines import machine_study

MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
DAMPER = MACHINE.damper(mass=0.6, gap="8 mm", restitution=0.7, contact_stiffness=2e7)
BALL = idm.HertzContact("20 mm", idm.Material("210 GPa", 0.3))


@pytest.fixture(scope="module")
def study():
    frequencies, gaps = np.linspace(20, 21, 3), np.linspace(7e-3, 8.5e-3, 4)
    return machine_study(
        MACHINE, DAMPER, frequencies, MACHINE.natural_frequency, gaps, starts=4, workers=2
    )


def test_every_variable_has_a_unit(study):
    for name in study.variables:
        quantity = VARIABLES[name].quantity
        scaled = quantity in ("number", "mixed")
        assert (study[name].attrs["units"] in ("1", "radian")) == scaled, name


def test_without_the_damper_the_resonance_is_that_of_the_closed_form(study):
    peak = 40 / (2 * 0.005 * 2e5 * math.sqrt(1 - 0.005**2))
    assert study["bare_displacement"].max() == pytest.approx(1e3 * peak, rel=1e-3)


def test_a_violent_motion_beside_the_quiet_one_is_found():
    """The hardening machine at 24 Hz, at gaps where all of few random starts end quiet."""
    hard = replace(MACHINE, cubic_stiffness=4e9)
    damper = hard.damper(mass=0.6, gap="3 mm", restitution=0.8, contact_stiffness=2e7)
    data = machine_study(hard, damper, [23.9, 24], 24.0, [2e-3, 3e-3], starts=12, workers=2)
    assert (data["quiet_displacement"] < 0.4).all()
    assert (data["largest_displacement"] > 5).all()


def test_gaps_are_full_plays(study):
    np.testing.assert_allclose(study["gap"], [7, 7.5, 8, 8.5])
    np.testing.assert_allclose(study["gap"], 2 * study["clearance"])
    assert json.loads(study.attrs["machine"])["gap"] == 0.008
    assert float(study["optimum_gap"]) == 2 * float(study["optimum_clearance"])
    size, gap = float(study["optimum_displacement"]), float(study["optimum_gap"])
    words = f"quiet motion of {size:.4g} mm at the gap {gap:.4g} mm (full play)"
    assert study.attrs["optimum"].startswith(words)


def test_the_loose_mass_of_the_quiet_motion_holds_the_force():
    """At resonance the spring carries the inertia, and what is left is the force F = 40 N.

    A quiet machine at rest takes the impulses of a loose mass that crosses the gap in half a
    period; their first harmonic, 8 m2 g w^2/(2 pi^2) for the gap g, is F near the optimum.
    """
    angular = 2 * math.pi * MACHINE.natural_frequency
    gap = 40 * math.pi**2 / 8 * 2 / (0.6 * angular**2)
    gaps = np.linspace(0.85, 0.95, 3) * gap
    data = machine_study(
        MACHINE, DAMPER, [20.5, 20.6], MACHINE.natural_frequency, gaps, starts=4, workers=2
    )
    assert float(data["quiet_displacement"].min()) < 0.05 * 20
    assert data["quiet_share"].max() > 0


def test_without_a_quiet_motion_words_say_so():
    gaps = np.linspace(1e-3, 2e-3, 3)
    frequency = MACHINE.natural_frequency
    data = machine_study(MACHINE, DAMPER, [20.5, 20.6], frequency, gaps, starts=2, workers=2)
    assert int(data["optimum_kind"]) == flag("optimum_kind", "not_found")
    assert data.attrs["optimum"] == (
        "no quiet motion: none of the starts, 2 of them random, at each of 3 gaps from 1 to 2 mm "
        "(full play) leads to one"
    )
    assert (data["quiet_share"] == 0).all()


def test_a_contact_after_hertz_agrees_with_its_motion():
    soft = replace(DAMPER, contact_stiffness=None, contact=BALL)
    frequency = MACHINE.natural_frequency
    found = idm.hertz_stiffness(MACHINE, soft, frequency)
    assert int(found["hertz_status"]) == flag("hertz_status", "consistent")
    # of the motion with this stiffness, run anew
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
