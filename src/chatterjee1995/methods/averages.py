"""Averages over a chaotic motion. The scatter over batches of cycles gives standard errors."""

import math

import numpy as np

from chatterjee1995.methods.labels import STATISTICS
from chatterjee1995.methods.rigid_impacts import rigid_map, without_dashpot
from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions.strobe_map import strobe_time


def of_run(p, run, begin, periods, batch):
    """Return averages over each batch of cycles: contacts per cycle, and max |Z1| of a cycle."""
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


def exponents(p, start, tolerance, periods, batch, restitution=None):
    """Return the largest Lyapunov exponent in each batch. With a `restitution` walls are rigid."""
    y, tangent, work = start.copy(), np.full((1, 4), 0.5), workspace()
    side, begin, period = side_of(p, y), strobe_time(p), 2 * math.pi / p[FREQUENCY]
    rows = np.empty(periods)
    for k in range(periods):
        if restitution is None:
            side, _, _ = advance(p, y, tangent, side, begin, begin + period, tolerance, work)
        else:
            y, matrix, *_ = rigid_map(without_dashpot(p), restitution, y, tolerance)
            tangent[0] = matrix @ tangent[0]
        size = np.linalg.norm(tangent)
        tangent /= size
        rows[k] = math.log(size) / period
    return rows[: periods // batch * batch].reshape(-1, batch).mean(axis=1)


def estimates(batches):
    """Return the mean (row 0) and standard error (row 1) of each average, NaN without batches."""
    table = np.full((2, len(STATISTICS)), np.nan)
    for k, name in enumerate(STATISTICS):
        if name in batches:
            values = batches[name]
            table[:, k] = values.mean(), values.std(ddof=1) / math.sqrt(len(values))
    return table
