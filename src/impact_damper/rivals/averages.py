"""Averages of a chaotic motion with their standard errors, from batches of forcing cycles.

The forcing cycles of a run are grouped into batches of successive cycles. The average is the mean
of the batch means, and its standard error follows from the scatter of the batch means.
"""

import math

import numpy as np

from impact_damper.contact.rigid_impacts import rigid_map
from impact_damper.kernel.single import advance, side_of, workspace
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.rivals.methods import STATISTICS
from impact_damper.system.packed import DASHPOT, FREQUENCY


def of_run(p, run, begin, periods, batch):
    """Return for each batch the contacts per cycle, and the mean over cycles of the largest |Z1|.

    `run` is a `runs.Run` from the time `begin`, and `batch` is the number of cycles in a batch.

    Returns
    -------
    dict
        Arrays of shape (periods // batch,), keyed by the name of the statistic.
    """
    count = periods // batch
    edges = begin + 2 * math.pi / p[FREQUENCY] * np.arange(count * batch + 1)
    contacts = np.histogram(run.contact_times, edges)[0]
    largest = np.zeros(count * batch)
    within = np.searchsorted(edges, run.peak_times, side="right") - 1
    kept = within < len(largest)
    np.maximum.at(largest, within[kept], run.peaks[kept])
    return {
        "contact_rate": contacts.reshape(count, batch).mean(axis=1),
        "displacement": largest.reshape(count, batch).mean(axis=1),
    }


def exponents(p, start, tolerance, periods, batch):
    """Return the largest Lyapunov exponent per unit of time in each batch, by the Taylor series."""
    y, tangent, work = start.copy(), np.full((1, 4), 0.5), workspace()
    side, begin, period = side_of(p, y), strobe_time(p), 2 * math.pi / p[FREQUENCY]
    rows = np.empty(periods)
    for k in range(periods):
        side, _, _ = advance(p, y, tangent, side, begin, begin + period, tolerance, work)
        tangent[0], growth = _renormalised(tangent[0])
        rows[k] = growth / period
    return rows[: periods // batch * batch].reshape(-1, batch).mean(axis=1)


def rigid_exponents(restitution, p, start, tolerance, periods, batch):
    """Return the largest Lyapunov exponent per unit of time in each batch, by the rigid model."""
    p = p.copy()
    p[DASHPOT] = 0.0
    y, tangent, period = start.copy(), np.full(4, 0.5), 2 * math.pi / p[FREQUENCY]
    rows = np.empty(periods)
    for k in range(periods):
        y, matrix, _, _, _, _ = rigid_map(p, restitution, y, tolerance)
        tangent, growth = _renormalised(matrix @ tangent)
        rows[k] = growth / period
    return rows[: periods // batch * batch].reshape(-1, batch).mean(axis=1)


def _renormalised(tangent):
    """Return a tangent scaled to length 1, and the logarithm of its length before."""
    size = np.linalg.norm(tangent)
    return tangent / size, math.log(size)


def estimates(batches):
    """Return mean and standard error of each of STATISTICS, shape (2, 3), NaN for missing ones.

    `batches` is a dictionary from the name of a statistic to its values in the batches.
    """
    table = np.full((2, len(STATISTICS)), np.nan)
    for k, name in enumerate(STATISTICS):
        if name in batches:
            values = batches[name]
            table[:, k] = values.mean(), values.std(ddof=1) / math.sqrt(len(values))
    return table
