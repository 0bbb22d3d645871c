"""Order solutions that are found at each frequency by itself along branches over frequency."""

import numpy as np

# Solutions at neighbouring frequencies are of one branch only if they are closer than this share of
# the largest solution; a longer way is a jump.
JUMP = 0.25


def branches_over(rows) -> list[np.ndarray]:
    """Number the solutions at each value of a parameter by branches that do not jump.

    A solution continues the branch of the solution at the value before that is nearest to it, if it
    is also the nearest to that one. Where two branches meet and vanish, at a fold, each of the two
    moves less than they are apart, so they are not confused. Other solutions begin a branch.

    Parameters
    ----------
    rows : list of array, shape (count, m)
        Coordinates of the solutions at each value of the parameter, continuous along a branch.

    Returns
    -------
    list of numpy.ndarray of int, shape (count,)
        Numbers of the branches, from 0 in order of their first solutions.
    """
    sizes = [np.max(np.abs(row)) for row in rows if len(row)]
    reach = JUMP * max(sizes, default=1.0)
    numbers, begun = [], 0
    last, names = np.empty((0, 1)), np.empty(0, int)
    for row in rows:
        found = np.full(len(row), -1)
        if len(row) and len(last):
            distance = np.linalg.norm(row[:, None] - last[None], axis=2)
            before, after = distance.argmin(axis=1), distance.argmin(axis=0)
            place = np.arange(len(row))
            kept = (after[before] == place) & (distance[place, before] < reach)
            found[kept] = names[before[kept]]
        new = found < 0
        found[new] = begun + np.arange(new.sum())
        begun += int(new.sum())
        numbers.append(found)
        last, names = row, found
    return numbers
