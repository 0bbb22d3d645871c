"""One run of the migration controller, the scheme of figure 17.

A run begins with the large free motion of period 1. The damper is switched on and off repeatedly
until the free oscillator settles to the small one: off after the motion with it has settled, at a
phase drawn uniformly over the period of this motion, or after `longest_hold` forcing cycles, during
the next cycle.
"""

import numpy as np

from impact_damper.data.datasets import flag
from impact_damper.data.variables import DAMPED_MOTION, FREE_MOTION
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions import legs
from impact_damper.motions.records import MOTION, NEVER
from impact_damper.motions.releases import destination, kinds
from impact_damper.motions.traces import trace

# `course` returns Z1 against time from MARGIN forcing cycles before a run to MARGIN cycles after.
MARGIN = 10
# Number of values of Z1 in a forcing cycle.
SAMPLES = 40
# One entry of a log: the damper is switched on and off once. Times are in forcing cycles from the
# first strobe.
# on_time, off_time: times at which the damper is switched on and off.
# end_time: time at which the free motion after `off_time` has settled.
# released_*: period and max |Z1| of the motion with the damper.
# destination*: flag (`FREE_MOTION`) and max |Z1| of the free motion to which the release leads.
SWITCHING = np.dtype(
    [
        ("on_time", "f8"),
        ("off_time", "f8"),
        ("end_time", "f8"),
        ("released_period", "i2"),
        ("released_displacement", "f8"),
        ("destination", "i1"),
        ("destination_displacement", "f8"),
    ]
)


def draw(seed, switchings):
    """Return the random numbers of one run, shape (switchings, 3), uniform between 0 and 1.

    A larger number of switchings adds rows at the end and leaves the others as they are.
    """
    return np.random.default_rng(seed).random((switchings, 3))


def blank(shape):
    """Return a log of the given shape in which no switching has taken place."""
    log = np.zeros(shape, SWITCHING)
    for name in SWITCHING.names:
        if SWITCHING[name].kind == "f":
            log[name] = np.nan
    log["destination"] = FREE_MOTION["none"]
    return log


def control(case, draws, longest_hold, settling, periods, stop=NEVER):
    """Return path and log of one run of the controller.

    Parameters
    ----------
    case : ReleaseCase
    draws : array, shape (n, 3)
        Result of `draw`. A row holds the phase at which the damper is switched on, the place of the
        loose mass in the gap at this time, and the phase at which the damper is switched off. A
        phase is a fraction of the period of the motion before the switching.
    longest_hold : int
        Forcing cycles after which the damper is switched off even if its motion has not settled.
    settling : Settling
    periods : int
        Forcing cycles after which no further switching begins.
    stop : array of bool, shape (1,)
        Argument of `legs.run`.

    Returns
    -------
    path : numpy.ndarray, shape (m, 5)
        One row for each strobe and each switching: forcing cycles from the first strobe, then the
        state Z1, Z1', Z2, Z2'.
    log : numpy.ndarray of SWITCHING, shape (n,)
        One entry for each switching.
    """
    y = case.state.copy()
    records = np.zeros(1, MOTION)
    record = records[0]
    record["period"] = 1
    log = blank(len(draws))
    rest = np.empty((max(longest_hold, settling.limit) + 2, 5))
    path, strobe = [], 0.0

    def leg(before, after, phase, place, limit):
        nonlocal strobe
        wait = phase * max(int(record["period"]), 1)
        instant = strobe + wait
        strobe = legs.leg(
            before, after, y, wait, place, strobe, settling.tolerance, limit, rest, records, stop
        )
        path.append(rest[: record["periods_run"] + 2].copy())
        return instant

    for entry, draw in zip(log, draws, strict=True):
        entry["on_time"] = leg(case.off, case.on, draw[0], 2 * draw[1] - 1, longest_hold)
        entry["released_period"] = record["period"]
        entry["released_displacement"] = record["maximum_displacement"]
        entry["off_time"] = leg(case.on, case.off, draw[2], 0.0, settling.limit)
        entry["end_time"] = strobe
        entry["destination"] = destination(case.known, record)
        entry["destination_displacement"] = record["maximum_displacement"]
        if entry["destination"] == FREE_MOTION["non_resonance"] or strobe >= periods:
            break
    return np.concatenate(path), log


def course(case, path, log, tolerance):
    """Return times T and Z1 along a run, with MARGIN forcing cycles before and after the run.

    Each interval between two rows of the path is integrated from the state in the path. From the
    first state alone the error would grow in chaotic parts until the result differs from the run.
    """
    period = 2 * np.pi / case.on[FREQUENCY]
    path = np.vstack([np.append(-MARGIN, case.state), path])
    ends = np.append(path[1:, 0], path[-1, 0] + MARGIN)
    times = np.arange(-MARGIN * SAMPLES, int(ends[-1] * SAMPLES)) / SAMPLES
    log = log[log["destination"] != FREE_MOTION["none"]]
    switched = np.stack([log["on_time"], log["off_time"]], axis=-1).ravel()
    damped = np.searchsorted(switched, (path[:, 0] + ends) / 2) % 2 == 1
    cuts = np.searchsorted(times, np.append(path[:, 0], ends[-1]))
    states = np.empty((len(times), 4))
    for row, on, first, last in zip(path, damped, cuts, cuts[1:], strict=False):
        trace(
            case.on if on else case.off,
            row[1:].copy(),
            (row[0] + 0.25) * period,
            (times[first:last] + 0.25) * period,
            tolerance,
            states[first:last],
            np.empty((0, 5)),
        )
    return (times + 0.25) * period, states[:, 0]


def switching_data(logs, case):
    """Return a dict of dataset variables of the switchings, with dimensions (..., switching)."""
    period = 2 * np.pi / case.on[FREQUENCY]
    kind = kinds(logs["released_period"], logs["released_displacement"], case.known)
    absent = logs["destination"] == FREE_MOTION["none"]
    data = {name: (logs[name] + 0.25) * period for name in ("on_time", "off_time", "end_time")}
    data["released_from"] = np.where(absent, DAMPED_MOTION["none"], kind)
    return data | {name: logs[name] for name in SWITCHING.names[3:]}


def run_totals(logs):
    """Return a dict of dataset variables of whole runs.

    Times are in forcing cycles from the moment at which the damper is first switched on.
    """
    first = logs["on_time"][..., 0]
    reached = np.any(logs["destination"] == FREE_MOTION["non_resonance"], axis=-1)
    return {
        "trial_outcome": np.where(
            reached, flag("trial_outcome", "reached"), flag("trial_outcome", "not_reached")
        ),
        "switchings": np.sum(logs["destination"] != FREE_MOTION["none"], axis=-1),
        "damper_time": np.nansum(logs["off_time"] - logs["on_time"], axis=-1),
        "release_time": np.nanmax(logs["off_time"], axis=-1) - first,
        "total_time": np.nanmax(logs["end_time"], axis=-1) - first,
    }
