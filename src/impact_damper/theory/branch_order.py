"""Sort solutions, found at each frequency separately, into branches over the frequency."""

import numpy as np

# Solutions at neighbouring frequencies can belong to one branch only if their distance is below
# JUMP times the size of the largest solution. Between neighbouring points of the usual grids a
# branch moves by less than this.
JUMP = 0.25


def branches_over(rows) -> list[np.ndarray]:
    """Return the number of the branch of each solution, at each value of a parameter.

    Two solutions at neighbouring values of the parameter belong to the same branch if each is the
    nearest solution to the other, and the distance between them is below JUMP times the size of the
    largest solution. Any other solution begins a new branch. Two branches that meet at a fold are
    told apart if each moves less from value to value than the distance between them.
    """
    sizes = [np.max(np.abs(row)) for row in rows if len(row)]
    reach = JUMP * max(sizes, default=1.0)
    numbers, begun = [], 0
    last, names = np.empty((0, 1)), np.empty(0, int)
    for row in rows:
        branch = np.full(len(row), -1)
        if len(row) and len(last):
            distance = np.linalg.norm(row[:, None] - last[None], axis=2)
            before, after = distance.argmin(axis=1), distance.argmin(axis=0)
            place = np.arange(len(row))
            kept = (after[before] == place) & (distance[place, before] < reach)
            branch[kept] = names[before[kept]]
        new = branch < 0
        branch[new] = begun + np.arange(new.sum())
        begun += int(new.sum())
        numbers.append(branch)
        last, names = row, branch
    return numbers
