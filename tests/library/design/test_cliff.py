"""Ranges of quiet gaps that are too narrow to build a gap in, with made-up edges."""

import numpy as np
import pytest
from helpers.design_tasks import compared, task

from impact_damper.design import cliff
from impact_damper.design.cliff import HOLDABLE, can_be_held, choose_with_edges

TASK = task()


def edges(low, high):
    return tuple(cliff.Edge(gap, np.nan, 0, 20.5) for gap in (low, high))


@pytest.mark.parametrize(
    ("width", "tolerance", "held"),
    [
        (0.0, 0.1, False),
        (0.9 * HOLDABLE, 0.1, False),
        (1.1 * HOLDABLE, 0.1, True),
        (0.003, 0.001, True),  # the user asked for a closer tolerance
        (0.001, 0.001, False),
    ],
)
def test_a_gap_is_held_as_closely_as_one_can(width, tolerance, held):
    assert can_be_held(edges(8.0, 8.0 * (1 + width)), tolerance) == held


def quiet_ranges(monkeypatch, quiet, width):
    """Return 9 gaps from 1 to 4 mm, and the result of `choose_with_edges` for them.

    The gaps with the indices `quiet` are quiet. Each quiet range extends from such a gap up to this
    gap times (1 + `width`).
    """
    shares = np.where(np.isin(np.arange(9), quiet), 1.0, 0.5)[:, None]
    gaps = np.geomspace(1, 4, 9)

    def compare(task, tried, *_, **__):
        ranges = [(gaps[k], gaps[k] * (1 + width)) for k in quiet]
        is_quiet = any(low <= tried[0] <= high for low, high in ranges)
        return compared(tried, [[1.0 if is_quiet else 0.5]], [[1.0]])

    monkeypatch.setattr(cliff, "compare", compare)
    return gaps, choose_with_edges(TASK, compared(gaps, shares, np.ones((9, 1))))


def test_a_quiet_gap_without_a_range_is_no_design(monkeypatch):
    _, (choice, (low, high)) = quiet_ranges(monkeypatch, (2, 6), 0.0)
    assert choice.kind == "least_worst"
    assert np.isnan(low.gap) and np.isnan(high.gap)


def test_a_narrow_range_is_measured_and_its_middle_taken(monkeypatch):
    gaps, (choice, (low, high)) = quiet_ranges(monkeypatch, (4,), 0.06)
    assert choice.kind == "needs_tolerance"
    assert low.gap == gaps[4]
    assert high.gap <= gaps[4] * 1.06 < high.beyond
    assert low.gap < choice.gap < high.gap
