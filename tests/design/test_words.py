"""The conclusion of a design: which sentences stand when."""

import numpy as np
import pytest
from helpers.made_up_design import MACHINE, made_up_design

import impact_damper as idm
from impact_damper.design.task import Task
from impact_damper.design.words import conclusion

TASK = Task(
    machine=idm.Machine(**MACHINE),
    mass=0.6,
    band=(26.0, 34.0),
    restitution=0.7,
    contact_stiffness=2e7,
    tolerances={"gap": 0.1},
)
VIOLENT = {"reached_displacement": [0.8, 9.5, 0.8, 0.8, 0.8]}


def said(kind="robust", **changed):
    return " ".join(conclusion(TASK, kind, made_up_design(choice=kind, **changed)))


def test_a_robust_gap_is_promised_within_its_tolerance():
    words = said()
    assert "Build a gap of 7 mm (full play, from wall to wall); any gap from 6.3 to 7.7 mm" in words
    assert "The machine then moves at most 2 mm, instead of 10 mm without the damper" in words
    assert "at least 95 % of all starts" in words and "at 95 % confidence" in words
    assert "does it move more than 0.8 mm" in words


def test_a_gap_that_needs_a_closer_tolerance_is_held_between_its_cliffs():
    words = said("needs_tolerance", cliff_gap=[6.5, 7.5], cliff_status=[0, 0])
    assert "hold it from 6.5 to 7.5 mm, a narrower range than the tolerance of 10 %" in words
    # the comparison of gaps was too coarse to see this range
    assert "hold it from 6 to 8.5 mm. The" in said("needs_tolerance", cliff_status=[0, 0])


def test_a_range_that_goes_on_beyond_what_was_looked_at_is_said_to():
    assert "hold it from 6 or less to 8.5 mm. The" in said("needs_tolerance")
    words = said(stability_gap_event=[4, 0], stability_force_event=[0, 4])
    assert "is stable from 6.5 or less to 8.8 mm" in words
    assert "is stable from 0.5 to 2 or more times the nominal excitation" in words


def test_a_large_motion_is_told_with_the_starts_that_lead_to_it():
    assert "All random starts lead to quiet motions, but slow changes" in said(**VIOLENT)
    some = said(**VIOLENT, reached_quiet_share=[1, 0.97, 1, 1, 1])
    told = "Some starts do not lead to quiet motions: in the largest motion the machine moves up to"
    assert f"{told} 9.5 mm" in (some)
    escaped = said(reached_displacement=[np.inf, 1, 1, 1, 1])
    assert "the machine escapes over its barrier" in escaped


def test_a_loose_mass_that_floats_is_told_with_the_room_that_it_has():
    words = said(untouched_displacement=[np.nan, 3.1, 2.5, np.nan, np.nan])
    assert "moves less than that, up to 3.1 mm" in words
    assert "within 0.4 mm of the middle of the gap (11 % of it)" in words
    assert "until then the damper has no effect" not in said(displacement_limit=3.6)
    assert "moves half the gap, 3.5 mm: until then the damper has no effect" in said()
    assert "not touched" not in said()
    assert "not touched" not in said(untouched_displacement=[np.nan, 1.9, 1.9, 1.9, 1.9])  # quiet


def test_without_a_quiet_gap_the_words_say_what_there_is_and_what_would_help():
    words = said("least_worst")
    assert (
        "No range of gaps that one can hold (at least 1 % of the gap) is quiet over the whole band."
        in words
    )
    assert "Do not build this damper for this band." in words
    assert "What would help: a loose mass of 0.6 kg" in words


def test_distances_to_the_cliff_and_to_the_end_of_stability_are_apart():
    words = said()
    assert "21.4 % above this gap, at 8.5 mm (first at 30 Hz)" in words
    assert "Gaps are quiet at least down to 6 mm: no gap beyond was compared" in words
    assert "The quiet orbit at 30 Hz is stable from 6.5 to 8.8 mm: not this range" in words
    none = said(cliff_status=[1, 1])
    assert "Gaps are quiet at least down to 6 mm and up to 8.5 mm: no gap beyond" in none
    assert "The cliff" not in none


@pytest.mark.parametrize(
    ("rates", "told"),
    [
        (
            [[0.01, 0.005, 0.02]] * 2,
            "become quiet, on average, after another 100 cycles at 8 mm, 100 cycles at 9 mm.",
        ),
        (
            [[np.nan] * 3, [0.001, 0, 0.004]],
            "do not become quiet at 9 mm: none did within 3000 cycles. This chaos",
        ),
    ],
)
def test_transients_and_attractors_are_told_apart(rates, told):
    data = made_up_design().assign_coords(life_gap=("life", [8.0, 9.0]))
    data["life_rate"] = (("life", "bound"), rates)
    assert told in " ".join(conclusion(TASK, "robust", data))


def test_the_best_absorber_is_named_with_its_loss_when_detuned():
    words = (
        "the best tuned absorber of the same mass the machine would move up to 0.5 mm, and up to"
    )
    assert f"{words} 0.6 mm with its springs 10 % off" in said()
