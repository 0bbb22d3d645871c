"""Published numbers compared with those of this package, and the table of the differences.

r1 is the contact stiffness.
"""

import numpy as np
import pytest

from chatterjee1995.stages.published import GROUPS, published
from chatterjee1995.tables.published import SHOWN
from chatterjee1995.tables.published import published as table_of
from impact_damper.data.datasets import flag, load, save

SETTINGS = {
    "rigid_walls": {
        "damping_ratio": 0.01,
        "restitutions": [0.4],
        "mass_ratios": [0.05],
        "gaps": [40],
        "frequencies": [0.95, 1.0],
        "stiffnesses": [1e5, 1e6, 1e7],
    },
    "vibro_impact": {
        "restitution": 0.5,
        "damping_share": 0.5,
        "mass_ratios": [0.005, 0.0025],
        "contact_stiffness": 1e7,
    },
    "ring_down": {"restitution": 0.3, "mass_ratios": [0.005, 0.00125], "contact_stiffness": 1e6},
    "tuned_mass_dampers": {"mass_ratios": [0.05]},
    "nonlinear_absorbers": {"mass_ratio": 0.05, "forces": [0.02]},
    "basin_shares": {"starts": 500},
    "jump_frequencies": {"springs": [-1.0], "damping_ratios": [0.005], "peak": 0.8},
    "hertz_impacts": {"speeds": [0.5]},
}


@pytest.fixture(scope="module")
def data():
    return published(SETTINGS)


def of(data, reason):
    return data.isel(comparison=data.difference_reason.values == flag("difference_reason", reason))


def differences(data):
    return data.our_value.values / data.published_value.values - 1


def test_every_group_is_compared(data):
    assert SETTINGS.keys() == GROUPS.keys()
    assert len(set(data.comparison.values)) == data.sizes["comparison"] > 30
    assert set(data.publication.values) == set(range(8))


def test_rigid_walls_are_the_limit_of_stiff_contacts(data):
    """The difference falls as the square root of r1, and vanishes in the limit."""
    each = of(data, "contact_stiffness")
    assert np.all(np.abs(differences(each)) < 1e-3)
    np.testing.assert_allclose(each.difference_order, -0.5, atol=0.02)
    np.testing.assert_allclose(each.limit_value, each.published_value, rtol=1e-6)


def test_closed_forms_of_light_masses_are_of_first_order(data):
    each = of(data, "mass_ratio")
    assert np.all(np.abs(differences(each)) < 0.015)
    known = each.difference_order.values
    np.testing.assert_allclose(known[np.isfinite(known)], 1, atol=0.05)


def test_ring_down_agrees_with_the_closed_form(data):
    """The difference is below 1.5 % at the mass ratio 0.005, and below 0.4 % at 0.00125."""
    times = [str(name).startswith("time of ring-down") for name in data.comparison.values]
    first, second = differences(data.isel(comparison=times))
    assert abs(first) < 0.015 and abs(second) < 0.004


def test_absorbers(data):
    assert np.all(np.abs(differences(of(data, "direct_search"))) < 1e-6)
    assert np.all(differences(of(data, "fixed_points")) > 0)
    assert np.all(np.abs(differences(of(data, "first_order"))) < 2e-3)
    assert np.all(np.abs(differences(of(data, "one_harmonic"))) < 2e-3)


def test_differences_are_as_large_as_expected(data):
    """The differences for rigid walls and for Hertz's contact have the expected size.

    Those for small mass ratios have the expected order of magnitude.
    """
    for reason, tolerance in (("contact_stiffness", 0.05), ("linear_contact", 1e-3)):
        each = of(data, reason)
        known = np.isfinite(each.expected_difference.values)
        expected = each.expected_difference.values[known]
        np.testing.assert_allclose(np.abs(differences(each))[known], expected, rtol=tolerance)
    light = of(data, "mass_ratio")
    assert np.all(np.abs(differences(light)) < 3 * light.expected_difference.values)


def test_shares_differ_by_chance(data):
    each = of(data, "random_starts")
    off = (each.our_value - each.published_value) / each.difference_error
    assert np.all(np.abs(off) < 4)


def test_table_explains_every_difference(data, tmp_path):
    (tmp_path / "published").mkdir()
    path = tmp_path / "published" / "dampers.nc"
    save(data, path)
    table = table_of({"published": {"dampers": load(path)}})
    assert SHOWN["published"].keys() <= set(table)
    assert len(table) == data.sizes["comparison"]
    assert table.explanation.str.contains("right").all()
    assert not table.explanation.str.contains("nan").any()
    np.testing.assert_allclose(table.difference, differences(data))


def test_unknown_group_is_refused():
    with pytest.raises(ValueError, match="unknown groups .*walls.*known: rigid_walls"):
        published({"walls": {}})


def test_wrong_values_are_refused():
    with pytest.raises(ValueError, match="starts = 0: must be from 1"):
        published({"basin_shares": {"starts": 0}})
    with pytest.raises(ValueError, match="restitution = 2: must be finite"):
        published({"ring_down": SETTINGS["ring_down"] | {"restitution": 2}})
