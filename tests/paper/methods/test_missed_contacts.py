"""Contacts near grazing: passages (flights of known largest |Z2|) against heyoka, and counts."""

import math

import numpy as np
import pytest
from helpers.known_orbits import PAPER
from numpy.testing import assert_allclose
from scipy.stats import binom

from chatterjee1995.figures.failures import draw_missed_contacts
from chatterjee1995.methods import missed_contacts as missed
from chatterjee1995.methods.integrators import integrators, merson
from chatterjee1995.methods.passages import draw_passages
from chatterjee1995.tables.methods import missed_contacts
from impact_damper.model.packed import pack

PERIOD = math.pi
PASSAGES = 150
DEPTHS = np.geomspace(1e-12, 1e-1, 12)


@pytest.fixture(scope="module")
def passages():
    p = pack(PAPER, None, 2.0)
    return p, draw_passages(p, 40, 2.0, DEPTHS[-1], 7)


def test_the_largest_displacement_agrees_with_heyoka(passages):
    heyoka = pytest.importorskip("heyoka")
    p, drawn = passages
    x, v, z, w = heyoka.make_vars("x", "v", "z", "w")
    free = heyoka.cos(2.0 * heyoka.time) - p[1] * v - p[2] * x - x * x * x
    turning = []
    event = heyoka.nt_event(w, lambda motion, t, _: turning.append(at(motion, t)))
    motion = heyoka.taylor_adaptive(
        [(x, v), (v, free), (z, w), (w, free)], np.zeros(4), nt_events=[event], tol=1e-18
    )

    def at(motion, t):
        motion.update_d_output(t)
        return abs(motion.d_output[2])

    for passage in drawn:
        turning.clear()
        motion.time, motion.state[:] = 0.0, passage.state
        motion.propagate_until(PERIOD)
        assert_allclose(max(turning), passage.extremum, rtol=4e-15)


def test_the_taylor_series_misses_none_and_invents_none(passages):
    p, drawn = passages
    depths = np.geomspace(1e-13, 1e-1, 13)
    touching, spurious, _ = missed.counts(integrators()["taylor"], p, drawn, depths, 1e-14)
    assert_allclose(touching, np.array([[len(drawn), 0, 0, 0]] * len(depths)))
    assert not spurious.any()


@pytest.mark.thorough
def test_fixed_steps_miss_contacts_with_the_expected_probability():
    """A step h ends beyond the wall with the probability (time beyond the wall)/h."""
    given = dict(tolerances=[1e-12, 1e-3], steps=[32, 2048])
    counted = missed.missed_contacts(
        PAPER, 2.0, passages=PASSAGES, radius=2.0, depths=DEPTHS, **given
    )
    counts = counted.passage_count.sel(integrator="runge_kutta_4", method_tolerance=1e-12)
    count, expected = PASSAGES, counted.expected_unseen[0]
    for depth in DEPTHS[DEPTHS > 1e-8]:
        missing = count - int(counts.sel(contact_outcome="found", depth=depth))
        share = float(expected.sel(depth=depth))
        low, high = binom.interval(1 - 1e-4, count, share)
        assert low <= missing <= high
    # Every passage is counted once.
    assert (counted.passage_count.sum("contact_outcome") == PASSAGES).all()
    assert (counted.passage_count.sel(contact_outcome="failed") == 0).all()


@pytest.mark.thorough
def test_failed_runs_are_neither_found_nor_missed(monkeypatch):
    """In dataset, table and figure the share of missed contacts counts only completed runs."""
    monkeypatch.setattr(merson, "MOST_FLIGHT_ENDS", 40)
    data = missed.missed_contacts(
        PAPER, 2.0, passages=3, radius=2.0, depths=DEPTHS, tolerances=[1e-12, 1e-3], steps=[8, 16]
    )
    of = data.sel(integrator="merson")
    assert of.contacts_missed[0].isnull().all() and of.contacts_missed[1].notnull().all()
    table = missed_contacts({"missed_contacts": {"one": data}})
    row = table.set_index("method").loc["Merson"].iloc[0]
    assert row["failed"] == row["contacts near grazing"] and np.isnan(row["half missed to depth"])
    drawn = draw_missed_contacts(missed_contacts=[data])
    assert any("failed" in text.get_text() for text in drawn.legends[0].get_texts())


def test_numbers_of_steps_and_of_tolerances_must_agree():
    given = dict(passages=2, radius=2.0, depths=[0.1], tolerances=[1e-6], steps=[8, 16])
    with pytest.raises(ValueError, match="as many as tolerances"):
        missed.missed_contacts(PAPER, 2.0, **given)
