"""Lines through the motions of a response connect neighbours of one period, up to branch ends."""

import numpy as np
import pytest

from impact_damper.data.datasets import dataset
from impact_damper.plot.lines import branch_lines, lines


def test_lines_keep_apart_what_is_stored_in_any_order():
    x = np.linspace(0, 1, 9)
    curves = np.stack([x, 2 - x, 3 + x])
    shuffled = np.array(
        [np.random.default_rng(i).permutation(row) for i, row in enumerate(curves.T)]
    )
    found = lines(x, shuffled, np.zeros(shuffled.shape, int))
    found = sorted((list(values) for _, _, values in found), key=lambda values: values[0])
    np.testing.assert_allclose(found, curves)


def test_lines_end_at_gaps_and_groups_do_not_mix():
    x = np.arange(6.0)
    y = np.stack([x, x + 0.1], axis=1)
    group = np.array([[0, 1]] * 2 + [[-1, 1]] + [[0, 1]] * 3)
    found = {(name, tuple(at)) for name, at, _ in lines(x, y, group)}
    assert found == {(0, (0, 1)), (0, (3, 4, 5)), (1, tuple(x))}


@pytest.fixture
def response():
    """Return a branch that doubles its period at W = 3; its ends lie between two frequencies."""
    data = {
        "maximum_displacement": np.array([[9.0], [1.0], [2.0], [3.0], [9.0]]),
        "branch": np.array([[-1], [4], [4], [4], [-1]]),
        "period": np.array([[0], [1], [1], [2], [0]]),
        "end_branch": [4, 4],
        "end_direction": [-1, 1],
        "end_value": [0.75, 3.25],
        "end_displacement": [0.5, 3.5],
    }
    return dataset(data, {"frequency": np.arange(5.0)}, {}, "made up")


def test_branches_reach_to_their_ends_and_split_where_the_period_changes(response):
    found = branch_lines(response, response["branch"].values >= 0)
    assert [(list(at), list(values)) for at, values in found] == [
        ([0.75, 1, 2], [0.5, 1, 2]),
        ([3, 3.25], [3, 3.5]),
    ]
