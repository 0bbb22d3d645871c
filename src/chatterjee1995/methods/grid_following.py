"""Orbits at the points ("cells") of a grid of parameters, followed from cell to cell."""

from collections import deque

import numpy as np

from impact_damper.motions.following import Followed, follow

SHORTEST = 1 / 32  # shortest step along a line between two points, divided by the line's length


def follow_line(
    correct, first, last, orbit, *, shortest=SHORTEST, extrapolating=False, behind=None
) -> Followed:
    """Call `follow` with these arguments, for parameters on a line from `first` to `last`."""

    def correct_at(fraction, guess):
        return correct((1 - fraction) * first + fraction * last, guess)

    return follow(
        correct_at,
        0.0,
        1.0,
        orbit,
        shortest=shortest,
        growth=2.0 if extrapolating else 1.0,  # steps that are powers of 2 add up to exactly 1
        extrapolating=extrapolating,
        behind=behind,
    )


class Grid:
    """Orbits in the cells of a grid, each followed from the orbit of a neighbouring cell.

    `points[cell]` holds the parameters of a cell. `correct(parameters, guess)` returns the orbit
    near the state `guess`, or None, and a status. `orbits` is a dict: cell -> orbit.
    """

    def __init__(self, points, correct, *, shortest=SHORTEST, axes=None, extrapolating=False):
        self.points, self.correct = points, correct
        self.shortest, self.extrapolating = shortest, extrapolating
        self.shape = points.shape[:-1]
        axes = range(len(self.shape)) if axes is None else axes
        unit = np.eye(len(self.shape), dtype=int)
        self._directions = [turn * unit[axis] for axis in axes for turn in (-1, 1)]
        self.orbits = {}

    def spread(self):
        """Follow orbits into neighbouring cells, breadth first, until no new cell is reached."""
        queue = deque(self.orbits)
        while queue:
            cell = queue.popleft()
            for direction in self._directions:
                target = self.beside(cell, direction)
                if target is None or target in self.orbits:
                    continue
                followed = self.follow(cell, direction)
                if followed.arrived:
                    self.orbits[target] = followed.orbit
                    queue.append(target)

    def beside(self, cell, direction):
        """Return the neighbour of a cell in a direction, or None if it lies outside the grid."""
        target = tuple(int(i) for i in np.add(cell, direction))
        inside = all(0 <= i < size for i, size in zip(target, self.shape, strict=True))
        return target if inside else None

    def follow(self, cell, direction) -> Followed:
        """Follow the orbit of a cell to the neighbouring cell in a direction."""
        return follow_line(
            self.correct,
            self.points[cell],
            self.points[self.beside(cell, direction)],
            self.orbits[cell],
            shortest=self.shortest,
            extrapolating=self.extrapolating,
            behind=self.orbits.get(self.beside(cell, np.negative(direction))),
        )
