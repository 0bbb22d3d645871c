"""Label states of an oscillator with its damper by the motion that they lead to.

No proven neighbourhoods of attractors exist for motions with contacts. Therefore each motion is run
until it has settled (`motions.watch`).

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass, W the
forcing frequency, and T the time.
"""

import numpy as np

from impact_damper.data.variables import BASIN_LABEL
from impact_damper.kernel.batch import advance
from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.motions import ensemble, records, traces
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, strobe_time

# Two settled motions of the same period are the same if max |Z1| differs relatively by less than
# SAME. Mirror images are therefore one motion.
SAME = 1e-5
# Labels of motions that have not settled to an orbit with contacts, keyed by their outcome.
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
    """Return labels of states with the damper on, and the attractors that the labels refer to.

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
    labels : numpy.ndarray of int, shape (n,)
        Index of the attractor, or a negative value of `data.variables.BASIN_LABEL`.
    periods : numpy.ndarray of int, shape (n,)
        Number of cycles for which each motion was run.
    attractors : numpy.ndarray of records.MOTION, shape (k,)
        By ascending max |Z1|.
    """
    begin = phase % (2 * np.pi) / p[FREQUENCY]
    strobe = strobe_time(p) + (2 * np.pi / p[FREQUENCY] if begin > strobe_time(p) else 0.0)
    starts = to_strobe(p, states, begin, strobe, settling.tolerance)
    motions = ensemble.settle(
        np.tile(p, (len(starts), 1)),
        starts,
        settling,
        from_strobe=True,
        workers=workers,
        progress=progress,
    )
    labels = np.full(len(motions), BASIN_LABEL["unresolved"])
    for outcome, label in LABELS.items():
        labels[motions["outcome"] == outcome] = label
    attractors = []
    settled = np.flatnonzero(motions["outcome"] == records.SETTLED)
    order = settled[np.argsort(motions["maximum_displacement"][settled], kind="stable")]
    for i in order:
        for index, known in enumerate(attractors):
            ratio = motions["maximum_displacement"][i] / known["maximum_displacement"]
            if known["period"] == motions["period"][i] and abs(ratio - 1) < SAME:
                labels[i] = index
                break
        else:
            labels[i] = len(attractors)
            attractors.append(motions[i])
    return labels, motions["periods_run"], np.array(attractors, records.MOTION)


def to_strobe(p, states, begin, strobe, tolerance):
    """Return the states at the time `strobe` of motions with given states at the time `begin`."""
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
    """Return Z1, Z1' of an orbit at all times with a given forcing phase, shape (period, 2)."""
    period = 2 * np.pi / p[FREQUENCY]
    begin = strobe_time(p)
    first = begin + (phase / p[FREQUENCY] - begin) % period
    times = first + period * np.arange(record["period"])
    states = np.empty((len(times), 4))
    traces.trace(
        p, record["state"].copy(), begin, times, POLISH_TOLERANCE, states, np.empty((0, 5))
    )
    return states[:, :2]
