"""Random starts of a design, and which of their motions are quiet."""

import numpy as np
import pytest
from helpers.design_tasks import task

from impact_damper.data.datasets import flag
from impact_damper.design.outcomes import STREAMS, Case, are_quiet, draw_starts, run

TASK = task()
CASES = [Case(8e-3, 20.5), Case(8e-3, 20.5), Case(9e-3, 20.6)]


def test_each_case_and_each_purpose_has_starts_of_its_own():
    drawn = [draw_starts(TASK, CASES, 10, stream) for stream in STREAMS]
    states = np.concatenate(drawn).reshape(-1, 4)
    assert len(np.unique(states, axis=0)) == len(states)
    assert (draw_starts(TASK, CASES, 10, "coarse") == drawn[STREAMS.index("coarse")]).all()


def test_the_motions_do_not_depend_on_the_number_of_threads():
    one, two = (run(task(workers=n), CASES, 70, "coarse") for n in (1, 2))
    assert one.tobytes() == two.tobytes()


@pytest.mark.parametrize(
    ("outcome", "size", "quiet"),
    [
        ("settled", 1.9, True),
        ("settled", 2.1, False),
        ("chaotic", 1.9, False),
        ("chaotic", 1.3, True),
        ("unresolved", 1.4, False),
        ("non_colliding", 1.9, True),
        ("escaped", np.inf, False),
    ],
)
def test_a_motion_that_has_not_settled_needs_room_for_later_peaks(outcome, size, quiet):
    assert are_quiet(size, flag("outcome", outcome), 2.0) == quiet
