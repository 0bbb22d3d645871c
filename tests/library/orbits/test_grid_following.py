"""Orbits followed over a grid: the cells reached, their order, and where following ends."""

from types import SimpleNamespace

import numpy as np
from numpy.testing import assert_allclose

from impact_damper.orbits.grid_following import Grid, follow_line

POINTS = np.stack(np.meshgrid(np.arange(5.0), np.arange(5.0), indexing="ij"), axis=-1)


def known(point):
    return SimpleNamespace(state=np.array(point, float))


def correction(lost):
    """Return a function for the argument `correct` of `Grid`."""

    def correct(point, _):
        return (None, "not_followed") if lost(*point) else (known(point), "found")

    return correct


def spread(lost, **options):
    """Return the grid after spreading from a corner."""
    grid = Grid(POINTS, correction(lost), **options)
    grid.put((0, 0), known([0, 0]))
    grid.spread()
    return grid


def slit(x, y):
    return abs(x - 2) < 0.2 and y < 3


def test_cells_behind_a_slit_are_reached_around_it():
    grid = spread(slit)
    assert set(np.ndindex(5, 5)) - set(grid.orbits) == {(2, 0), (2, 1), (2, 2)}
    for cell, orbit in grid.orbits.items():
        assert_allclose(orbit.state, POINTS[cell])


def test_cells_behind_a_wall_are_not_reached():
    grid = spread(lambda x, y: x > 1.5)
    assert len(grid.orbits) == 10
    assert {cell[0] for cell in grid.orbits} == {0, 1}


def test_a_line_passes_a_narrow_gap_in_halved_steps_and_no_wide_one():
    """An orbit is found if the point differs from the predicted state by at most 0.3."""

    def correct(point, guess):
        if abs(point[0] - guess[0]) > 0.3:
            return None, "not_followed"
        reached.append(point[0])
        return known(point), "found"

    first, last = np.zeros(1), np.ones(1)
    for extrapolating, expected in ((False, [0.25, 0.5, 0.75, 1]), (True, [0.25, 0.75, 1])):
        reached = []
        followed = follow_line(correct, first, last, known([0]), extrapolating=extrapolating)
        assert followed.arrived and reached == expected
    followed = follow_line(correct, first, last, known([0]), shortest=0.5)
    assert not followed.arrived
    assert (followed.value, followed.status) == (0, "not_followed")


def test_the_cell_behind_improves_the_first_prediction():
    guesses = []

    def correct(point, guess):
        guesses.append(guess)
        return known(point), "found"

    for extrapolating in (False, True):
        grid = Grid(POINTS, correct, extrapolating=extrapolating)
        grid.put((0, 0), known([0, 0]))
        grid.put((1, 0), known([1, 0]))
        grid.follow((1, 0), (1, 0))
    assert [list(guess) for guess in guesses] == [[1, 0], [2, 0]]
