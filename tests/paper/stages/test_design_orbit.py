"""The exact quiet orbit at peak frequencies: motions settle on the orbit only if it is stable."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from chatterjee1995.stages.design_orbit import design_orbit
from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.theory.design_rule import peak_frequency

LINEAR = Oscillator(0.215, 1.5)
RULE = Damper(0.12, 1 / (0.12 * peak_frequency(LINEAR) ** 2))


@pytest.fixture(scope="module")
def linear():
    return design_orbit(LINEAR, RULE, settling=Settling())


def settles(damping, data):
    """Return whether a motion that starts near the orbit settles on it."""
    place = int(np.argmin(np.abs(data["followed_value"].values - damping)))
    oscillator = Oscillator(float(data["followed_value"][place]), 1.5)
    p = pack(oscillator, RULE, peak_frequency(LINEAR))
    state = data["orbit_state"].values[place] + np.array([1e-3, 0, 1e-3, 0])
    settling = Settling(patience=300, limit=2000)
    assert_allclose(data["orbit_phase"][place], np.pi / 2)
    record = ensemble.settle(p[None], state[None], settling, from_strobe=True)[0]
    near = abs(record["maximum_displacement"] - float(data["orbit_displacement"][place])) < 1e-6
    return bool(record["outcome"] == 1 and near)


def test_it_is_unstable_with_the_linear_spring_of_figure_3a(linear):
    assert_allclose(linear["followed_value"].values[[0, -1]], [0.215, 2.0])
    assert linear["orbit_stability"][0] == flag("orbit_stability", "unstable")
    assert linear["event_kind"].values.tolist() == [flag("event_kind", "neimark_sacker")]


def test_simulation_agrees_on_both_sides(linear):
    edge = float(linear["event_value"][0])
    assert settles(edge * 1.15, linear) and not settles(edge * 0.85, linear)


def test_starts_do_not_settle_where_it_is_unstable(linear):
    assert linear["design_orbit_status"] == flag("design_orbit_status", "found")
    assert not np.any(linear["design_run_outcome"] == flag("design_run_outcome", "settled"))
    assert linear["design_run_displacement"].max() > 5 * float(linear["orbit_displacement"][0])


def test_an_orbit_that_is_not_found_has_a_status():
    """The only start meets no wall, so there is no orbit to follow."""
    data = design_orbit(LINEAR, Damper(0.12, 500.0), starts=1, settling=Settling())
    assert data["design_orbit_status"] == flag("design_orbit_status", "no_start")
    assert data.sizes["point"] == 0
