"""The map of the contact model over restitution and load, and contacts of simulated motions."""

from dataclasses import replace

import numpy as np
import pytest
from helpers.known_orbits import INELASTIC, PAPER, polished_orbit
from numpy.testing import assert_allclose

from chatterjee1995.figures.contact_model import draw_contact_model
from chatterjee1995.stages.contact_model import contact_map, contact_model, spread_loads
from chatterjee1995.stages.logged_contacts import extreme_motions, logged_contacts, without_pull
from chatterjee1995.tables.contact import SHOWN
from chatterjee1995.tables.contact import contact_model as model_table
from impact_damper.data.datasets import flag
from impact_damper.data.variables import VARIABLES
from impact_damper.model.settling import Settling
from impact_damper.motions.simulate import simulate
from impact_damper.theory.contact_law import contact, natural_frequency


def test_verdicts_follow_from_the_restitution():
    restitutions, loads = np.linspace(0.1, 1, 8), spread_loads(5, 9)
    found = contact_map(restitutions, loads)
    error = np.abs(found["realised_restitution"] / restitutions - 1)
    verdict = found["contact_verdict"]
    assert np.array_equal(verdict == flag("contact_verdict", "close"), error <= 0.01)
    assert np.array_equal(
        verdict == flag("contact_verdict", "fair"), (error > 0.01) & (error <= 0.05)
    )
    ended = np.isfinite(found["contact_duration"])
    assert np.array_equal(verdict == flag("contact_verdict", "no_release"), ~ended)
    middle = len(loads) // 2
    assert loads[middle] == 0
    assert (verdict[0, middle] == flag("contact_verdict", "close")).all()


def test_loads_are_symmetric_and_reach_the_largest():
    loads = spread_loads(10, 81)
    assert_allclose(loads, -loads[::-1], atol=1e-18)
    assert loads[-1] == pytest.approx(10)


def test_logged_contacts_are_those_of_the_simulation():
    scene = polished_orbit("inelastic")
    seen = logged_contacts(PAPER, INELASTIC, 2.0, scene.state, 3)
    motion = simulate(PAPER, INELASTIC, 2.0, scene.state, periods=3, start=scene.strobe)
    expected = -motion.departure_velocity / motion.approach_velocity
    assert_allclose(seen["restitution"], expected, atol=1e-10)
    begin = motion.contact_begin.values
    x, v = (np.interp(begin, motion.time, motion[name]) for name in ("displacement", "velocity"))
    pull = motion.contact_wall * (np.cos(2 * begin) - PAPER.damping * v - x**3)
    load = pull / (natural_frequency(INELASTIC) * np.abs(motion.approach_velocity))
    assert_allclose(seen["load"], load, atol=1e-4)


def test_stiffer_contacts_agree_better_with_the_closed_form():
    """The closed form assumes a constant load, which changes less in a shorter contact."""
    scene = polished_orbit("inelastic")
    errors = []
    for stiffness in (1e4, 1e6):
        each = replace(INELASTIC, contact_stiffness=stiffness)
        seen = logged_contacts(PAPER, each, 2.0, scene.state, 1)
        expected = contact(0.75, seen["load"][0], "zero_penetration").departure
        errors.append(abs(seen["restitution"][0] - expected))
    assert errors[0] < 1e-3
    assert errors[0] / errors[1] == pytest.approx(10, rel=0.1)


@pytest.fixture(scope="module")
def model():
    return contact_model(
        PAPER, INELASTIC, [2.0], [0.2, 0.75, 1.0], [-1, 0, 1], used=[0.75, 1.0], starts=2, periods=3
    )


def test_dataset(model):
    assert (model.scene_contacts == 6).all()
    assert_allclose(model.scene_restitution_error, 0, atol=1e-3)
    assert model.sizes["contact"] == model.scene_contacts.sum()
    assert (model.scene_without_pull_status == flag("scene_without_pull_status", "found")).all()
    elastic = model.sel(used=1.0)
    assert_allclose(elastic.scene_without_pull, elastic.scene_displacement)
    stiffer = model.sel(used=0.75)
    assert (stiffer.scene_without_pull < stiffer.scene_displacement).all()


def test_why_a_motion_without_pull_is_not_given():
    """The status says why no motion with walls that cannot pull was found."""
    settling = Settling()
    motion, _ = extreme_motions(PAPER, INELASTIC, 2.0, 2, 1995, settling)
    names = VARIABLES["scene_without_pull_status"].flags
    changes = {
        "found": {},
        "not_settled": {"outcome": flag("outcome", "chaotic")},
        "other_contacts": {"contacts": motion["contacts"] + 1},
        "not_followed": {"state": [0, 3.0, 0, 0]},
    }
    for name, change in changes.items():
        changed = motion.copy()
        for key, value in change.items():
            changed[key] = value
        size, status = without_pull(PAPER, INELASTIC, 2.0, changed)
        assert status == names[name]
        assert np.isfinite(size) == (name == "found")


def test_tables_and_figure(model):
    data = {"contact_model": {"one": model}}
    counts = model_table(data).dropna(subset="cells")
    verdicts = ["close", "fair", "off", "falls back", "no release"]
    assert (counts[verdicts].sum(axis=1) == 9).all()
    assert SHOWN["contact_model"].keys() <= set(model_table(data))
    # A map for each exit rule, and the colour scale.
    assert len(draw_contact_model(contact_model=[model]).axes) == 3


def test_bad_arguments_are_named():
    with pytest.raises(ValueError, match="loads = .*: must be increasing"):
        contact_model(PAPER, INELASTIC, [2.0], [0.5, 1.0], [1, 0], used=[0.5, 1.0])
    with pytest.raises(ValueError, match="count = 1: must be from 2"):
        spread_loads(10, 1)
