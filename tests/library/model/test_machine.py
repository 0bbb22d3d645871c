"""Machines and dampers: scales, forces, and wrong values, which are refused in SI units."""

import math
from dataclasses import replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from impact_damper.model.machine import Machine, describe_si, static_deflection

HARD = Machine(mass=12, linear_stiffness=2e5, cubic_stiffness=4e9, damping_ratio=0.005, force=40)
SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005}
DAMPER = {"mass": 0.6, "gap": "3 mm", "restitution": 0.8, "contact_stiffness": 2e7}
MACHINES = {
    "hard": HARD,
    "linear": Machine(**SPRING, force=40),
    "softening": Machine(**SPRING, cubic_stiffness=-4e9, force=10),
    "cubic alone": Machine(mass=2, cubic_stiffness=1e6, damping=0.4, force=3),
    "unbalanced": Machine(**SPRING, cubic_stiffness=4e9, unbalance="2 g m"),
    "on a base": Machine(**SPRING, base_displacement="0.2 mm"),
    "on a shaker": Machine(**SPRING, cubic_stiffness=4e9, base_acceleration="3 m/s^2"),
    "free": Machine(**SPRING, force=0),
}


@pytest.mark.parametrize("name", MACHINES)
def test_the_scaled_equation_is_that_of_the_machine(name):
    """At one state the equation in SI units and the scaled equation give the same acceleration."""
    machine, hertz = MACHINES[name], 24.0
    scales, angular = machine.scales, 2 * math.pi * hertz
    x, v = 1.7e-3, -0.4
    oscillator = machine.oscillator()
    w = scales.from_si(hertz, "frequency")
    amplitude = (machine.force or 0) + (machine.unbalance or 0) * angular**2
    moved = (machine.base_displacement or 0) * angular**2 + (machine.base_acceleration or 0)
    amplitude += machine.mass * moved
    assert oscillator.base == (moved > 0)
    spring = machine.linear_stiffness * x + machine.cubic_stiffness * x**3
    expected = (amplitude - machine.viscous_damping * v - spring) / machine.mass
    z, u = scales.from_si(x, "displacement"), scales.from_si(v, "velocity")
    found = (
        oscillator.forcing_amplitude(w)
        - oscillator.damping * u
        - oscillator.linear_frequency**2 * z
        - oscillator.cubic * z**3
    )
    assert scales.to_si(found, "acceleration") == pytest.approx(expected, rel=1e-8)
    assert w == pytest.approx(angular * scales.time, rel=1e-15)


@pytest.mark.parametrize("name", MACHINES)
def test_numbers_are_well_scaled(name):
    oscillator = MACHINES[name].oscillator()
    assert oscillator.linear_frequency**2 + abs(oscillator.cubic) == pytest.approx(1, rel=1e-14)


@given(st.floats(1e-6, 1e6), st.just(0) | st.floats(1e-9, 1e9), st.just(0) | st.floats(1e-9, 1e15))
def test_the_static_deflection_carries_the_force(force, linear, cubic):
    if linear == cubic == 0:
        return
    x = static_deflection(force, linear, cubic)
    assert linear * x + cubic * x**3 == pytest.approx(force, rel=1e-12)


def test_a_measured_resonance_describes_spring_and_dashpot():
    """k = m (2 pi f)^2 and c = m 2 pi f/Q. A changed mass keeps the parameters that were given."""
    rate = 2 * math.pi * 20
    made = Machine(mass=12, natural_frequency="20 Hz", quality_factor=100, force=40)
    assert made.linear_stiffness == pytest.approx(12 * rate**2, rel=1e-12)
    assert made.viscous_damping == pytest.approx(12 * rate / 100, rel=1e-12)
    heavy = replace(made, mass=24)
    assert heavy.natural_frequency == 20 and heavy.viscous_damping == pytest.approx(24 * rate / 100)
    assert replace(HARD, mass=48).natural_frequency == pytest.approx(HARD.natural_frequency / 2)
    assert Machine(**describe_si(made)).scales == made.scales


def test_damping_is_a_ratio_or_a_coefficient():
    ratio = HARD.damping_ratio
    same = replace(HARD, damping_ratio=None, damping=2 * ratio * math.sqrt(2e5 * 12))
    assert same.oscillator() == HARD.oscillator()


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"mass": -1}, "mass = -1 kg: must be at least 1e-15 kg"),
        (
            {"damping_ratio": 1},
            "damping_ratio = 1: must be greater than 0 and at most 0.99 (at 1, critical"
            " damping, nothing vibrates; 1 per cent is 0.01 or '1 %')",
        ),
        (
            {"damping_ratio": None, "damping": 4000},
            "damping = 4000 N s/m: must be at most 3067.4 N s/m (0.99 of",
        ),
        ({"damping_ratio": None}, "damping: must be given, or damping_ratio"),
        ({"force": None}, "excitation = none of them: must be one of force, base_displ"),
        ({"linear_stiffness": 0}, "linear_stiffness = 0 N/m: must be greater than 0 N/m with"),
        ({"mass": "12 m"}, "mass = '12 m': must be a number in kg, or text"),
    ],
)
def test_nonsense_is_refused_in_si_units(changes, told):
    with pytest.raises((TypeError, ValueError)) as raised:
        Machine(**SPRING | {"force": 40} | changes)
    assert str(raised.value).startswith(told)


@pytest.mark.parametrize(
    ("changes", "told"),
    [
        ({"mass": 500}, "mass = 500 kg: must be at least 1.2e-5 kg and at most 120 kg"),
        ({"clearances": (1, 1)}, "gap: must be given, the full play, or clearances in its place"),
        (
            {"mount": {"inclination": 2}},
            "inclination = 2 radian: must be at least 0 radian and at most",
        ),
        (
            {"mount": {"gravity": 1, "inclination": 1}},
            "gravity: must be left out with inclination, from which it follows",
        ),
        ({"gap": "0.1 µm"}, "gap = 1e-7 m: must be greater than 1.90476e-7 m (static play"),
    ],
)
def test_a_damper_is_refused_in_si_units(changes, told):
    with pytest.raises((TypeError, ValueError)) as raised:
        HARD.damper(**DAMPER | changes)
    assert str(raised.value).startswith(told)


def test_the_play_is_given_full_or_on_both_sides():
    full = HARD.damper(**DAMPER)
    assert full == HARD.damper(**DAMPER | {"gap": None, "clearances": ("1 mm", "2 mm")})
    assert HARD.scales.to_si(full.scaled(HARD.scales).clearance, "clearance") == pytest.approx(
        1.5e-3, rel=1e-15
    )
    assert "gap 3 mm (full play)" in str(full)


def test_a_frequency_has_bounds_in_hertz():
    for value in (0, -3, "0 rpm", 1e9):
        with pytest.raises(
            ValueError, match=r"^frequency = .*: must be at least 0\.2135\d+ Hz and"
        ):
            HARD.check_frequency("frequency", value)


def test_a_mount_gives_gravity_along_the_gap_and_friction():
    weight = 0.6 * 9.81
    sloping = {"inclination": "30 deg", "friction_coefficient": 0.2}
    for mount, gravity, friction in (
        ({"inclination": "90 deg"}, 9.81, 0),
        (sloping, 9.81 / 2, 0.2 * weight * math.sqrt(0.75)),
        (sloping | {"normal_force": "2 N"}, 9.81 / 2, 0.4),
        ({"gravity": -3, "friction": 1}, -3, 1),
    ):
        damper = HARD.damper(**DAMPER, mount=mount)
        assert (damper.gravity, damper.friction) == pytest.approx((gravity, friction))
        scaled = damper.scaled(HARD.scales)
        assert HARD.scales.to_si(scaled.friction, "acceleration") == pytest.approx(friction / 0.6)
    with pytest.raises(ValueError, match="^normal_force: must be given with friction_coefficient"):
        HARD.damper(**DAMPER, mount={"inclination": "90 deg", "friction_coefficient": 0.2})
    assert HARD.damper(**{**DAMPER, "gap": None}, clearances=(0, "3 mm")).gap == 3e-3
