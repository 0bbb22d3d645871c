"""Averages of a chaotic motion with their standard errors, from batches of forcing cycles.

The average is the mean of the means of batches of successive cycles, and its standard error follows
from their scatter.
"""

import math

import numpy as np

from chatterjee1995.methods.labels import STATISTICS
from chatterjee1995.methods.rigid_impacts import rigid_map
from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import DASHPOT, FREQUENCY
from impact_damper.motions.strobe_map import strobe_time


def of_run(p, run, begin, periods, batch):
    """Return the averages of a `Run` in each batch of forcing cycles, shape (periods // batch,).

    "contact_rate": contacts per cycle. "displacement": mean over the cycles of the largest |Z1| in
    a cycle.
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
    """Return the largest Lyapunov exponent per unit of T in each batch, by the Taylor series.

    `start` is the state at W T = pi/2.
    """
    y, tangent, work = start.copy(), np.full((1, 4), 0.5), workspace()
    side, begin, period = side_of(p, y), strobe_time(p), 2 * math.pi / p[FREQUENCY]
    rows = np.empty(periods)
    for k in range(periods):
        side, _, _ = advance(p, y, tangent, side, begin, begin + period, tolerance, work)
        tangent[0], growth = _renormalised(tangent[0])
        rows[k] = growth / period
    return rows[: periods // batch * batch].reshape(-1, batch).mean(axis=1)


def rigid_exponents(restitution, p, start, tolerance, periods, batch):
    """Return the same as `exponents` for rigid walls with a given restitution."""
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
    """Return a tangent vector scaled to length 1, and the logarithm of its former length."""
    size = np.linalg.norm(tangent)
    return tangent / size, math.log(size)


def estimates(batches):
    """Return the mean (row 0) and standard error (row 1) of each of STATISTICS, shape (2, 3).

    `batches` maps statistics to their values in the batches; a missing statistic gives NaN.
    """
    table = np.full((2, len(STATISTICS)), np.nan)
    for k, name in enumerate(STATISTICS):
        if name in batches:
            values = batches[name]
            table[:, k] = values.mean(), values.std(ddof=1) / math.sqrt(len(values))
    return table
