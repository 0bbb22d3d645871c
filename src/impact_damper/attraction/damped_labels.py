"""Label states of an oscillator with its damper by the motion that they lead to.

Where the loose mass bounces, no neighbourhood of an attractor is proven: each motion is run until
it has settled (`motions.watch`).
"""

import numpy as np

from impact_damper.data.variables.basins import BASIN_LABEL
from impact_damper.kernel.batch import advance
from impact_damper.motions import ensemble, records
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, strobe_time
from impact_damper.system.packed import CLEARANCE, FREQUENCY

# Relative difference in max |Z1| below which two settled motions of one period are the same; mirror
# images are thus one motion.
SAME = 1e-5
# Labels of motions that have not settled with contacts, keyed by their outcome.
LABELS = {
    records.UNRESOLVED: BASIN_LABEL["unresolved"],
    records.DIVERGED: BASIN_LABEL["escaped"],
    records.ESCAPED: BASIN_LABEL["escaped"],
    records.CHAOTIC: BASIN_LABEL["chaotic"],
    records.NON_COLLIDING: BASIN_LABEL["no_contact"],
    records.DRIFTING: BASIN_LABEL["no_contact"],
    records.QUASI_PERIODIC: BASIN_LABEL["quasi_periodic"],
}


def label_damped(p, states, phase, settling, workers=1, progress=None):
    """Return labels of states with the damper on, the periods run, and the attractors found.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters with a damper.
    states : array, shape (n, 4)
        Z1, Z1', Z2, Z2' at the phase.
    phase : float
        Phase W T of the forcing, radian.
    settling : Settling
    workers, progress
        As in `ensemble.settle`.

    Returns
    -------
    labels, periods : numpy.ndarray of int, shape (n,)
    attractors : numpy.ndarray of records.MOTION, shape (k,)
        By rising max |Z1|.
    """
    begin = phase % (2 * np.pi) / p[FREQUENCY]
    strobe = strobe_time(p) + (2 * np.pi / p[FREQUENCY] if begin > strobe_time(p) else 0.0)
    starts = to_strobe(p, states, begin, strobe, settling.tolerance)
    found = ensemble.settle(
        np.tile(p, (len(starts), 1)),
        starts,
        settling,
        from_strobe=True,
        workers=workers,
        progress=progress,
    )
    labels = np.full(len(found), BASIN_LABEL["unresolved"])
    for outcome, label in LABELS.items():
        labels[found["outcome"] == outcome] = label
    attractors = []
    settled = np.flatnonzero(found["outcome"] == records.SETTLED)
    order = settled[np.argsort(found["maximum_displacement"][settled], kind="stable")]
    for i in order:
        for index, known in enumerate(attractors):
            ratio = found["maximum_displacement"][i] / known["maximum_displacement"]
            if known["period"] == found["period"][i] and abs(ratio - 1) < SAME:
                labels[i] = index
                break
        else:
            labels[i] = len(attractors)
            attractors.append(found[i])
    return labels, found["periods_run"], np.array(attractors, records.MOTION)


def to_strobe(p, states, begin, strobe, tolerance):
    """Return states that are run from the time `begin` to a strobe."""
    y = np.array(states, float)
    number = len(y)
    sides = np.where(y[:, 2] > p[CLEARANCE], 1, np.where(y[:, 2] < -p[CLEARANCE], -1, 0))
    advance(
        np.tile(p, (number, 1)),
        y,
        sides.astype(np.int64),
        np.full(number, begin),
        np.full(number, strobe),
        tolerance,
        np.zeros(number, np.int64),
    )
    return y


def orbit_passages(p, record, phase):
    """Return Z1, Z1' of an orbit each time the forcing has a phase, shape (period, 2)."""
    period = 2 * np.pi / p[FREQUENCY]
    begin = strobe_time(p)
    first = begin + (phase / p[FREQUENCY] - begin) % period
    times = first + period * np.arange(record["period"])
    states = np.empty((len(times), 4))
    records.trace(
        p, record["state"].copy(), begin, times, POLISH_TOLERANCE, states, np.empty((0, 5))
    )
    return states[:, :2]
