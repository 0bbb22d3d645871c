"""Pareto front of several dampers against brute force; the best of several restitutions."""

import numpy as np
import pytest

from impact_damper.design.alternatives import best_restitution, is_best
from impact_damper.design.task import labelled


def brute_force(masses, costs):
    """Return which dampers are on the front.

    A damper is on it unless another one is no worse in mass and costs, and better in one of them.
    """
    rows = [(mass, *cost) for mass, cost in zip(masses, costs.tolist(), strict=True)]
    rows = [[float("inf") if each != each else each for each in row] for row in rows]
    return [
        not any(
            all(b <= a for a, b in zip(row, other, strict=True)) and other != row for other in rows
        )
        for row in rows
    ]


@pytest.mark.parametrize("seed", range(20))
def test_the_front_is_that_of_brute_force(seed):
    generator = np.random.default_rng(seed)
    masses = np.sort(generator.integers(1, 6, 9)) / 10  # with ties
    costs = generator.integers(1, 5, (9, 2)).astype(float)
    costs[generator.random((9, 2)) < 0.1] = np.nan
    assert is_best(masses, costs).tolist() == brute_force(masses, costs)


def test_an_escape_is_worse_than_any_number():
    assert list(is_best([0.1, 0.2], np.array([[np.nan, np.nan], [1.0, 1.0]]))) == [True, True]
    assert list(is_best([0.2, 0.1], np.array([[np.nan, np.nan], [1.0, 1.0]]))) == [False, True]


@pytest.mark.parametrize(
    ("sizes", "kinds", "best"),
    [
        ([1.0, 0.5, 0.8], [0, 0, 0], 1),
        ([1.0, 0.5, 0.8], [0, 1, 0], 2),
        ([1.0, 0.5, 0.8], [2, 2, 1], 2),
        ([float("inf"), 9.0], [2, 2], 1),
        ([0.5, 0.5], [0, 0], 0),
    ],
)
def test_the_kind_of_choice_counts_before_the_displacement(sizes, kinds, best):
    values = np.linspace(0.3, 0.8, len(sizes))
    made = {"tried_displacement": sizes, "tried_choice": kinds}
    assert best_restitution(labelled(made, tried_restitution=values)) == values[best]
