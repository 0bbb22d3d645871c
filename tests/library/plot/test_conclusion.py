"""The answer of a design: four paragraphs, and which exceptions it names for which results."""

import numpy as np
import pytest
from helpers.made_up_design import made_up_design

from impact_damper.data.datasets import flag
from impact_damper.plot import conclusion


def said(*given, **changed):
    """Return the paragraphs of a design, with flags given by their names."""
    named = {
        name: [flag(name, each) for each in value] if isinstance(value, list) else flag(name, value)
        for name, value in changed.items()
        if name.endswith(("_status", "_end", "_beyond")) or name == "confirmation"
    }
    return conclusion(made_up_design(*given, **changed | named))


def test_the_four_lines_of_a_damper_to_build():
    build, does, sure, condition = said(best_orbit_beyond="no")
    assert build.startswith("Build a gap of 7 mm (full play), from 6.3 to 7.7 mm")
    assert does.startswith("The machine then moves at most 1 mm, instead of 10 mm without damper.")
    assert "a tuned absorber of the same mass: 0.5 mm, and 0.6 mm with the absorber's spr" in does
    assert "for at least 95 % of all starts at each frequency from 26 to 34 Hz" in sure
    assert (
        "(gap 10 %, restitution 10 %)" in sure
        and "all but 1 of 96 new random starts stayed below" in sure
    )
    assert condition.startswith("Hold the gap below 8 mm, 14 % away: this is the cliff")


def test_a_damper_that_takes_too_little_off_is_not_to_be_built():
    build, _, _, condition, *_ = said("do_not_build")
    assert build.startswith("Do not build a damper: it takes less than a quarter off")
    assert "largest at 30 Hz, with gap +10 %; with all values as given it is 0.8 mm" in condition
    given = said("do_not_build", {"gap": 7e-3})[0]
    assert given.startswith("Do not build this damper") and "Its gap is 7 mm" in given
    assert said("build", {"gap": 7e-3})[0].startswith("Keep the gap of 7 mm")


@pytest.mark.parametrize(
    ("limit", "status", "told"),
    [
        (1.25, "met", "The limit of 1.25 mm is met, with 0.25 mm (20 %) to spare."),
        (0.8, "missed", "The limit of 0.8 mm is missed by 0.2 mm (25 %)."),
    ],
)
def test_a_limit_is_met_or_missed_by_a_number(limit, status, told):
    words = said(displacement_limit=limit, limit_status=status)
    assert told in words[1]
    assert "limit" not in " ".join(said())
    # A mass that meets the limit is named only if this one does not.
    assert ("of 1.2 kg with a gap of 3 mm meets the limit" in " ".join(words)) == (limit == 0.8)


def test_motions_that_escape_have_no_size():
    words = said("do_not_build", promised_displacement=np.inf, limit_status="missed")
    assert "may escape over the barrier of its spring, instead of 10 mm" in words[1]
    assert said(tuned_displacement=np.nan)[1].endswith("or the machine escapes with it.")


def test_what_is_less_sure_is_said_in_the_third_line():
    doubts = said(confirmation="rounds_ended", peak_status="not_known", record_status="still_grows")
    for words in ("search ended before", "not known to 1 %", "still grew by more than 1 %"):
        assert words in doubts[2] and words not in said()[2]


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"keeping_end": ["search_ends", "growth"]}, "below 8 mm, 14 % away: beyond, the machine"),
        ({"keeping_gap": [6.2, 9.5], "keeping_end": ["jump", "jump"]}, "Hold the gap above 6.2 mm"),
        ({"keeping_gap": [6.9, 8], "keeping_end": ["jump", "jump"]}, "6.3 mm, 10 % away: this is"),
        (
            {"keeping_end": ["search_ends", "search_ends"]},
            "at 2 times the one given the machine moves 6 mm, which is more than in proportion",
        ),
        (
            {
                "keeping_end": ["search_ends", "search_ends"],
                "force_map_displacement": np.ones((5, 5)),
            },
            "no excitation up to four times the one given breaks this promise",
        ),
    ],
)
def test_the_condition_is_what_breaks_the_promise_first(changed, told):
    assert told in said(**changed)[3]


def test_exceptions_are_named_only_if_they_are_true():
    assert "The quiet orbit is smallest, 0.4 mm, at a gap of 8.8 mm" in said()[4]
    ordinary = said(best_orbit_beyond="no")
    assert len(ordinary) == 4
    worse = said(
        best_orbit_beyond="no", worst_ratio=1.5, promise_bare_displacement=[0.48, 0.6, 10, 10, 0.6]
    )
    told = (
        "At 26 to 28 Hz and 34 Hz the damper is worse than none: up to 0.72 mm instead of 0.48 mm"
    )
    assert worse[4] == f"{told}, at 26 Hz."
    floating = said(best_orbit_beyond="no", untouched_displacement=[np.nan, 3.1, 2.5, 1, 1])
    assert "before it moves 3.5 mm" in floating[4] and floating[4].endswith("up to 3.1 mm.")
    status = ["failed", "computed", "failed"] + ["computed"] * 3
    failed = said(best_orbit_beyond="no", addition_status=status)
    assert failed[4].endswith("failed: motions and forces at the gap; other excitations.")
