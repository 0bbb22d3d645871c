"""Design tasks: error messages for wrong values, and derived values."""

import math

import numpy as np
import pytest
from helpers.design_tasks import task

import impact_damper as idm
from impact_damper.design.promise import factor_sets

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005}
NATURAL = math.sqrt(2e5 / 12) / (2 * math.pi)


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"band": (25, 30)}, r"band = 25 Hz to 30 Hz: .* resonance of the machine, at 20.55 Hz"),
        ({"band": (21, 20)}, r"band = 21 Hz to 20 Hz: must ascend"),
        ({"band": np.linspace(20, 21, 9)}, r"`frequencies` of the effort"),
        ({"tolerances": {"gap": "0.2 N"}}, r"tolerances\['gap'\] = '0.2 N': must be a number"),
        ({"tolerances": {"force": "80 N"}}, r"tolerances\['force'\] = 2: .* at most 0.9"),
        (
            {"displacement_limit": 1.5},
            r"displacement_limit = 1.5 m: .* at most 0.02.* m \(the",
        ),
        ({"gap": 2}, r"gap = 2 m: .* at most 0.04.* m \(full play; .* does not touch"),
        ({"mass": "13 kg"}, r"mass = '13 kg': .* at most 12 kg \(mass of the machine"),
        ({"tolerances": {"gap": "120 %"}}, r"tolerances\['gap'\] = '120 %': .* at most 0.9"),
        ({"tolerances": {"play": 0.1}}, r"tolerances = 'play': must be of gap"),
        (
            {"tolerances": {"restitution": 0.855}, "restitution": 0.3},
            r"restitution 0.3 may fall to 0.0435",
        ),
        ({"starts": 58}, r"starts = 58: must be from 59 .*share of 0.95 at 95 % confidence"),
        ({"starts": 73, "share": 0.99}, r"starts = 73: must be from 299"),
        ({"machine": idm.Machine(**SPRING, force=0)}, r"without excitation nothing is to"),
    ],
)
def test_a_wrong_value_is_refused_with_its_reason(changed, told):
    with pytest.raises(ValueError, match=told):
        task(**changed)


def test_absolute_tolerances_are_fractions_of_the_nominal_values():
    """A tolerance of the gap is a fraction of each gap: 0.2 mm are 5 % of 4 mm and 20 % of 1 mm."""
    given = {"gap": "0.2 mm", "force": "2 N", "contact_stiffness": "1e6 N/m", "restitution": 0.1}
    made = task(tolerances=given)
    np.testing.assert_allclose(made.deviations(4.0), [0.05, 0.1, 0.05, 0, 0, 0, 0, 0.05])
    np.testing.assert_allclose(made.gap_ends(np.array([1.0, 4.0])), [[0.8, 3.8], [1.2, 4.2]])
    relative = task(tolerances=given | {"gap": "5 %"})
    np.testing.assert_array_equal(factor_sets(made, 4.0), factor_sets(relative, 4.0))


def test_gaps_of_a_vertical_damper_reach_as_high_as_the_loose_mass_is_thrown():
    """A mass thrown upwards at the speed v of the machine at resonance rises by v^2/(2 g)."""
    level, upright = task(), task(mount={"inclination": "90 deg"})
    speed = 40 / 2e5 / (2 * 0.005) * 2 * math.pi * NATURAL
    higher = upright.gap_span[1] - level.gap_span[1]
    assert higher == pytest.approx(1e3 * speed**2 / (2 * 9.81), rel=1e-3)


def test_the_number_of_starts_is_the_least_for_the_confidence():
    """All of n starts lie below a quantile with the probability share^n."""
    for share in (0.8, 0.9, 0.95, 0.99):
        least = next(n for n in range(1, 10**4) if share**n <= 0.05)
        assert task(share=share, starts=least).effort.starts == least
        with pytest.raises(ValueError, match="starts"):
            task(share=share, starts=least - 1)


def test_resonances_in_the_band_are_frequencies_of_the_grid():
    grid = task(band=(19, 22), frequencies=9).grid
    for mass in (12, 12.6):
        frequency = math.sqrt(2e5 / mass) / (2 * math.pi)
        assert np.abs(grid - frequency).min() < 1e-9
    assert grid[0] == 19 and grid[-1] == 22 and len(grid) == 9


def test_the_bare_machine_moves_as_its_closed_form_says():
    made = task(frequencies=9)
    r = made.grid / NATURAL
    exact = 40 / 2e5 / np.hypot(1 - r**2, 2 * 0.005 * r)
    assert made.bare == pytest.approx(1e3 * exact, rel=1e-6)
    assert made.worst_frequency == pytest.approx(NATURAL)


def test_a_contact_after_hertz_has_the_stiffness_of_an_impact_across_the_gap_of_the_rule():
    """The loose mass crosses 2 F/(m2 w^2) in half a cycle; F = k q^(3/2) stops the reduced mass."""
    ball = idm.HertzContact("20 mm", "210 GPa", 0.3)
    made = task(contact=ball, mass=1.2)
    frequency, reduced = 20.55, 12 * 1.2 / 13.2
    speed = 2 * frequency * 2 * 40 / (1.2 * (2 * math.pi * frequency) ** 2)
    deepest = (5 * reduced * speed**2 / (4 * ball.coefficient)) ** 0.4
    assert made.contact_stiffness == pytest.approx(reduced * speed**2 / deepest**2, rel=1e-9)


def test_at_the_gap_of_the_rule_the_force_moves_the_loose_mass_by_half_of_it():
    assert task().rule_gap(20.5) == pytest.approx(2 * 40 / (0.6 * (2 * math.pi * 20.5) ** 2))
