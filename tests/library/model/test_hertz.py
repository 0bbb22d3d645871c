"""Hertz's impact against its equation of motion, and Johnson, Contact Mechanics, 1985."""

import math

import pytest
from scipy.integrate import solve_ivp

from impact_damper.model.hertz import HertzContact

STEEL = ("210 GPa", 0.3)


@pytest.mark.parametrize(("radius", "speed", "mass"), [(0.01, 0.5, 0.6), (0.2, 3.0, 0.02)])
def test_an_impact_is_that_of_the_equation_of_motion(radius, speed, mass):
    contact = HertzContact(radius, *STEEL, wall_youngs_modulus=7e10, wall_poissons_ratio=0.33)
    k = contact.coefficient
    scale = (mass * speed**2 / k) ** 0.4

    def turned(t, y):
        return y[1]

    def parted(t, y):
        return y[0]

    parted.direction, parted.terminal = -1, True
    run = solve_ivp(
        lambda t, y: [y[1], -k * max(y[0], 0) ** 1.5 / mass],
        (0, 20 * scale / speed),
        [0, speed],
        events=(turned, parted),
        rtol=1e-12,
        atol=1e-18,
        max_step=0.05 * scale / speed,
    )
    found = contact.impact(speed, mass)
    deepest = run.y_events[0][0][0]
    assert found.compression == pytest.approx(deepest, rel=1e-8)
    assert found.force == pytest.approx(k * deepest**1.5, rel=1e-8)
    assert found.duration == pytest.approx(run.t_events[1][-1], rel=1e-6)
    # The equivalent linear spring stores the kinetic energy of the impact at the largest depth.
    stiffness = contact.stiffness(speed, mass)
    assert 0.5 * stiffness * deepest**2 == pytest.approx(0.5 * mass * speed**2, rel=1e-8)


def test_two_equal_materials_halve_the_modulus():
    """The contact modulus is E* = E/(2 (1 - nu^2)) (Johnson, 1985, equation 4.23)."""
    modulus = 2.1e11 / (2 * (1 - 0.3**2))
    assert HertzContact("1 cm", *STEEL).coefficient == pytest.approx(
        4 / 3 * modulus * 0.1, rel=1e-14
    )


def test_pressure_is_that_over_the_circle_of_contact():
    """The largest pressure is 3 F/(2 pi a^2), and a^3 = 3 F R/(4 E*)."""
    contact, force = HertzContact("1 cm", *STEEL), 300.0
    area = math.pi * (3 * force * 0.01 / (4 * contact.modulus)) ** (2 / 3)
    assert contact.pressure(force) == pytest.approx(1.5 * force / area, rel=1e-13)
    assert contact.pressure(0) == 0


@pytest.mark.parametrize(
    ("loose", "wall", "share", "expected"),
    [
        ("400 MPa", "400 MPa", 0.99, "no"),
        ("400 MPa", "400 MPa", 1.01, "yes"),
        ("400 MPa", "300 MPa", 0.8, "yes"),
        ("400 MPa", None, 0.99, "unknown"),
        (None, "400 MPa", 1.01, "yes"),
        (None, None, 0.0, "unknown"),
    ],
)
def test_a_ball_yields_from_1_6_times_the_yield_strength(loose, wall, share, expected):
    """Yielding begins at a largest pressure of 1.6 times the yield strength."""
    contact = HertzContact(0.01, *STEEL, loose, *STEEL, wall)
    assert contact.yields(share * 1.6 * 400e6) == expected


def test_half_a_material_is_refused():
    with pytest.raises(ValueError, match="^wall_poissons_ratio: must be given with wall_youngs"):
        HertzContact(1, 1e9, 0.3, None, 1e9)
