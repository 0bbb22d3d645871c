"""Random starts of a design, and which of their motions are quiet.

A start is an initial state. A motion is quiet if its largest displacement is at most the quiet
limit.
"""

import numpy as np
import pytest

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.design.outcomes import STREAMS, Case, are_quiet, draw_starts, run
from impact_damper.design.task import Task

TASK = Task(
    machine=idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40),
    mass=0.6,
    band=(20.3, 20.8),
    restitution=0.7,
    contact_stiffness=2e7,
)
CASES = [Case(8e-3, 20.5), Case(8e-3, 20.5), Case(9e-3, 20.6)]


def test_each_case_and_each_purpose_has_starts_of_its_own():
    drawn = [draw_starts(TASK, CASES, 10, stream) for stream in STREAMS]
    states = np.concatenate(drawn).reshape(-1, 4)
    assert len(np.unique(states, axis=0)) == len(states)
    assert (draw_starts(TASK, CASES, 10, "coarse") == drawn[STREAMS.index("coarse")]).all()


def test_the_motions_do_not_depend_on_the_number_of_threads():
    one, two = (run(TASK, CASES, 70, "coarse", workers=n) for n in (1, 2))
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
