"""The map of the contact model over restitution and load, and contacts of simulated motions."""

import numpy as np
import pytest
from helpers.known_orbits import INELASTIC, PAPER, polished_orbit
from numpy.testing import assert_allclose

from chatterjee1995.figures.contact_model import draw_contact_model
from chatterjee1995.stages.contact_model import contact_map, contact_model, loads_of, spread_loads
from chatterjee1995.tables.contact import contact_model as model_table
from impact_damper.data.datasets import flag
from impact_damper.model.settling import Settling
from impact_damper.motions.simulate import simulate


def test_verdicts_follow_from_the_restitution():
    restitutions, loads = np.linspace(0.1, 1, 8), spread_loads(5, 9)
    found = contact_map(restitutions, loads)
    error = np.abs(found["realised_restitution"] / restitutions - 1)
    verdict = found["contact_verdict"]
    assert np.array_equal(verdict == flag("contact_verdict", "close"), error <= 0.01)
    fair = (error > 0.01) & (error <= 0.05)
    assert np.array_equal(verdict == flag("contact_verdict", "fair"), fair)
    stays = [flag("contact_verdict", each) for each in ("falls_back", "no_release")]
    assert np.array_equal(np.isnan(found["realised_restitution"]), np.isin(verdict, stays))
    middle = len(loads) // 2
    assert loads[middle] == 0
    assert (verdict[0, middle] == flag("contact_verdict", "close")).all()


def test_logged_contacts_are_those_of_the_simulation():
    scene = polished_orbit("inelastic")
    motion = simulate(PAPER, INELASTIC, 2.0, scene.state, periods=3, start=scene.strobe)
    begin = motion.contact_begin.values
    x, v = (np.interp(begin, motion.time, motion[name]) for name in ("displacement", "velocity"))
    pull = motion.contact_wall * (np.cos(2 * begin) - PAPER.damping * v - x**3)
    load = pull / (INELASTIC.contact_frequency * np.abs(motion.approach_velocity))
    assert_allclose(loads_of(PAPER, INELASTIC, 2.0, scene.state, 3), load, atol=1e-4)


@pytest.fixture(scope="module")
def model():
    given = {"used": [0.75, 1.0], "starts": 2, "periods": 3, "settling": Settling()}
    return contact_model(PAPER, INELASTIC, [2.0], [0.2, 0.75, 1.0], [-1, 0, 1], **given)


def test_contacts_of_motions(model):
    """At both restitutions, both starts lead to the quiet motion with two contacts a cycle."""
    assert model.sizes["contact"] == 2 * 2 * 6
    assert (np.bincount(model.contact_used) == 12).all()
    assert (np.abs(model.contact_load) < 0.01).all()


def test_table_and_figure(model):
    table = model_table({"contact_model": {"one": model}})
    counts = table.dropna(subset="map cells")
    verdicts = [head for head in table if head.startswith("cells ")]
    assert len(verdicts) == 5 and (counts[verdicts].sum(axis=1) == 9).all()
    # A map for each exit rule, and the colour scale.
    assert len(draw_contact_model(contact_model=[model]).axes) == 3
