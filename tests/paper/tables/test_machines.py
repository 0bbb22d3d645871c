"""The table of dampers designed for machines."""

import numpy as np
import pytest
from helpers.made_up_design import made_up_design

from chatterjee1995.tables.machines import machines


def row(**changed):
    (found,) = machines({"machines": {"made_up": made_up_design(**changed)}}).to_dict("records")
    return found


def test_a_row_states_what_to_build_what_it_does_and_how_sure_it_is():
    assert row() == {
        "machine": "made_up",
        "loose mass [kg]": 0.6,
        "band [Hz]": "26 to 34",
        "gap, full play [mm]": "7 ± 10 %",
        "advice": "build it",
        "largest displacement without damper [mm]": 10.0,
        "largest displacement with damper [mm]": 0.8,
        "quiet share of 1000 unseen starts": 1.0,
        "corners of the tolerances": 2,
        "least quiet share at a corner": 0.98,
        "promise, tested with new starts": "kept within all tolerances",
        "largest with the best tuned absorber [mm]": 0.5,
    }


@pytest.mark.parametrize(
    ("changed", "head", "words"),
    [
        ({"choice": "needs_tolerance"}, "advice", "build it, with a closer tolerance of the gap"),
        ({"choice": "least_worst"}, "advice", "do not build it"),
        ({"choice": "needs_tolerance"}, "gap, full play [mm]", "7, held from 6 or less to 8.5"),
        ({"promise": "nominal_kept"}, "promise, tested with new starts", "kept at nominal values"),
        ({"promise": "broken"}, "promise, tested with new starts", "BROKEN"),
        ({"promise": "none_made"}, "promise, tested with new starts", "none made"),
        (
            {"reached_displacement": [1, np.inf, 1, 1, 1]},
            "largest displacement with damper [mm]",
            "escapes",
        ),
    ],
)
def test_the_words_follow_the_flags(changed, head, words):
    assert row(**changed)[head] == words
