"""Orbits over a grid of parameters, followed from cell to cell."""

from collections import deque

import numpy as np

# Between neighbouring cells a step is halved down to this part of their distance.
SHORTEST = 1 / 32


def march(solve, start, goal, orbit):
    """Follow an orbit from point to point, its steps halved down to SHORTEST where it must be.

    Parameters
    ----------
    solve : callable
        Maps a point and a guess of the state to an orbit or None, and a status.
    start, goal : array
        Points.
    orbit : Orbit or RigidOrbit
        At the start.

    Returns
    -------
    orbit : or None
        At the goal.
    status : int
        Of the last solution sought.
    """
    gone, step = 0.0, 1.0
    while gone < 1.0:
        ahead = min(1.0, gone + step)
        found, status = solve(start + ahead * (goal - start), orbit.state)
        if found is not None:
            gone, orbit = ahead, found
        elif step > SHORTEST:
            step /= 2
        else:
            return None, status
    return orbit, status


def flood(solve, axes, cell, orbit, unseen):
    """Orbits over a grid, from one cell to its neighbours and on, as far as they can be followed.

    Parameters
    ----------
    solve
        As in `march`.
    axes : sequence of array
        Coordinates of the cells along each dimension.
    cell : tuple of int
        Where the orbit is.
    orbit : Orbit or RigidOrbit
    unseen : int
        Status of cells of which no neighbour has an orbit.

    Returns
    -------
    found : dict
        Orbits by cell.
    status : array of int
    """
    status = np.full([len(axis) for axis in axes], unseen)
    found, status[cell] = {cell: orbit}, 0
    queue = deque([cell])
    while queue:
        here = queue.popleft()
        for dimension in range(len(axes)):
            for step in (-1, 1):
                there = tuple(np.add(here, step * np.eye(len(axes), dtype=int)[dimension]))
                inside = 0 <= there[dimension] < len(axes[dimension])
                if not inside or there in found:
                    continue
                next_orbit, status[there] = march(
                    solve, point_of(axes, here), point_of(axes, there), found[here]
                )
                if next_orbit is not None:
                    found[there] = next_orbit
                    queue.append(there)
    return found, status


def point_of(axes, cell):
    """Coordinates of a cell."""
    return np.array([axis[i] for axis, i in zip(axes, cell, strict=True)])
