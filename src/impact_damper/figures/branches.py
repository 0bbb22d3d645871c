"""Lines through the motions of a response: who belongs to whom, and where a line ends.

The datasets list the motions of each frequency in no order that would hold from one
frequency to the next; a line joins those that belong together.
"""

import numpy as np


def lines(x, y, group):
    """Lines through the entries of a table that belong to one group, row by row.

    Parameters
    ----------
    x : array, shape (n,)
        Increasing values of the rows.
    y : array, shape (n, m)
        Entries; a line goes from an entry to the nearest of its group in the next row.
    group : array of int, shape (n, m)
        Negative where there is no entry.

    Returns
    -------
    list of (int, array, array)
        Group, abscissae and ordinates of each line.
    """
    found, live = [], []
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
                found.append(line)
    return [(name, np.array(at), np.array(values)) for name, at, values in found]


def branch_lines(response, chosen):
    """Lines through the chosen motions of a response, each up to where its branch ends.

    A branch in which the period changes gives a line for each period.

    Parameters
    ----------
    response : xarray.Dataset
        Of `frequency_response`.
    chosen : array of bool, shape (frequency, motion)

    Returns
    -------
    list of (array, array)
        Frequency and largest displacement.
    """
    frequency = response["frequency"].values
    branch, period = response["branch"].values, response["period"].values
    most = period.max(initial=0) + 1
    found = lines(
        frequency,
        response["maximum_displacement"].values,
        np.where(chosen, branch * most + period, -1),
    )
    found = [[name // most, at, values] for name, at, values in found]
    step = np.diff(frequency).max(initial=0)
    ends = ("end_branch", "end_direction", "end_value", "end_displacement")
    for name, direction, where, value in zip(*(response[key].values for key in ends), strict=True):
        last = -1 if direction > 0 else 0
        near = [
            line
            for line in found
            if line[0] == name and 0 <= direction * (where - line[1][last]) <= step
        ]
        if near:
            line = min(near, key=lambda line: abs(line[2][last] - value))
            place = len(line[1]) if direction > 0 else 0
            line[1:] = np.insert(line[1], place, where), np.insert(line[2], place, value)
    return [(at, values) for _, at, values in found]


def draw_lines(axes, found, role):
    """Lines of one role."""
    for at, values in found:
        axes.plot(at, values, **role)
