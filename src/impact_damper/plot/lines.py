"""Lines through the motions of a frequency response that belong to one branch.

The datasets list the motions at each frequency by size, so one motion may have different places in
the lists of neighbouring frequencies.
"""

import numpy as np


def lines(x, y, group):
    """Join the entries of a table into lines, from row to row within each group of entries.

    Parameters
    ----------
    x : array, shape (n,)
        Abscissae of the rows, increasing.
    y : array, shape (n, m)
        Ordinates. A line continues from an entry to the nearest one of its group in the next row.
    group : array of int, shape (n, m)
        Group of each entry; negative for no entry.

    Returns
    -------
    list of (int, array, array)
        Group, abscissae and ordinates of each line.
    """
    begun, live = [], []
    for value, row, names in zip(x, y, group, strict=True):
        pairs = sorted(
            (abs(line[2][-1] - row[k]), i, k)
            for i, line in enumerate(live)
            for k in np.flatnonzero(names == line[0])
        )
        continued = {}
        for _, i, k in pairs:
            if k not in continued and i not in continued.values():
                continued[k] = i
        before, live = live, []
        for k in np.flatnonzero(names >= 0):
            line = before[continued[k]] if k in continued else (names[k], [], [])
            line[1].append(value)
            line[2].append(row[k])
            live.append(line)
            if k not in continued:
                begun.append(line)
    return [(name, np.array(at), np.array(values)) for name, at, values in begun]


def branch_lines(response, chosen):
    """Return lines through chosen motions of a response, extended to the ends of their branches.

    A branch whose period changes gives one line for each period. The dataset holds the ends, which
    lie between two frequencies.

    Parameters
    ----------
    response : xarray.Dataset
        A result of `frequency_response`.
    chosen : array of bool, shape (frequency, motion)

    Returns
    -------
    list of (array, array)
        Frequency and largest displacement.
    """
    frequency = response["frequency"].values
    branch, period = response["branch"].values, response["period"].values
    most = period.max(initial=0) + 1
    joined = lines(
        frequency,
        response["maximum_displacement"].values,
        np.where(chosen, branch * most + period, -1),
    )
    joined = [[name // most, at, values] for name, at, values in joined]
    step = np.diff(frequency).max(initial=0)
    ends = ("end_branch", "end_direction", "end_value", "end_displacement")
    for name, direction, where, value in zip(*(response[key].values for key in ends), strict=True):
        last = -1 if direction > 0 else 0
        near = [
            line
            for line in joined
            if line[0] == name and 0 <= direction * (where - line[1][last]) <= step
        ]
        if near:
            line = min(near, key=lambda line: abs(line[2][last] - value))
            place = len(line[1]) if direction > 0 else 0
            line[1:] = np.insert(line[1], place, where), np.insert(line[2], place, value)
    return [(at, values) for _, at, values in joined]
