"""Migration control: the controller of figure 17, from the resonance to the non-resonance branch.

A run begins with the large free motion of period 1. The damper is switched on and off repeatedly
until the free oscillator settles to the small one, the goal: off after the motion with it has
settled, at a phase drawn uniformly over the period of this motion, or as soon as the state leads to
the goal.
"""

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.data.shares import BOUNDS, wilson
from impact_damper.data.variables import DAMPED_MOTION, FREE_MOTION
from impact_damper.model.arguments import read_forced
from impact_damper.model.bounds import (
    LIFETIME_RANGE,
    PERIODS_RANGE,
    RUNS_RANGE,
    SEED_RANGE,
    check_count,
    names_arguments,
)
from impact_damper.model.packed import FREQUENCY
from impact_damper.model.settling import check_settling
from impact_damper.motions import ensemble, legs
from impact_damper.motions.attractors import release_set
from impact_damper.motions.records import MOTION, NEVER
from impact_damper.motions.releases import (
    DESTINATIONS,
    KINDS,
    destination,
    kinds,
    release_case,
    release_data,
    settled_motions,
    transient_data,
    watch_runs,
)
from impact_damper.motions.traces import trace

# Number of cycles within which, by the paper, its controller reaches the non-resonance branch.
PAPER_CYCLES = 350
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


@names_arguments
def migrate(
    system,
    damper,
    frequency,
    *,
    release="settled",
    seed=1995,
    longest_hold=500,
    periods=2000,
    switchings=100,
    settling=None,
):
    """Switch the damper on and off until the free oscillator is on its small motion.

    This is one run of the controller of figure 17 of the paper, from the resonance branch. The
    damper is on until it is released, then off until the free motion has settled, and so on.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper or MachineDamper
    frequency : float
        Forcing frequency W, or Hz for a machine; both free motions of period 1 must exist there.
    release : {"settled", "state"}
        When to switch the damper off: at a random phase after the motion has settled, as in the
        paper, or as soon as the state of the primary mass leads to the small motion.
    seed : int or numpy.random.SeedSequence
        Seed of the switching phases and of the places of the loose mass.
    longest_hold : int
        Forcing cycles after which the damper is switched off in any case.
    periods : int
        Forcing cycles after which the damper is not switched on any more.
    switchings : int
        Largest number of switchings.
    settling : Settling, optional
        Its `tolerance` and, for the free oscillator, its `limit` are used.

    Returns
    -------
    xarray.Dataset
        For each `time` T (dimensionless) the displacement of the primary mass; for each `switching`
        the times T at which the damper is switched on and off and at which the free motion has
        settled, the motion before the release and the free motion after it; and totals of the run,
        in forcing cycles.

    Raises
    ------
    ValueError
        If the free oscillator lacks one of its two motions of period 1, or an argument is out of
        range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> run = idm.migrate(oscillator, damper, 1.95, seed=1)
    >>> "time" in run.dims
    True
    """
    settling = check_settling(settling)
    if not isinstance(seed, np.random.SeedSequence):
        check_count("seed", seed, **SEED_RANGE)
    model = read_forced(system, damper, frequency, needs_damper=True)
    case, made = _checked(model, longest_hold, periods, switchings, settling)
    if release not in ("settled", "state"):
        raise ValueError(f"release = {release!r}: must be 'settled' or 'state'")
    inside = None
    if release == "state":
        inside = release_set(model.oscillator, model.frequency, settling)
    path, log = control(case, draw(seed, switchings), longest_hold, settling, periods, inside)
    totals = run_totals(log)
    log = log[: totals["switchings"]]
    times, displacement = course(case, path, log, settling.tolerance)
    data = {"displacement": displacement}
    data |= {name: ("switching", values) for name, values in switching_data(log, case).items()}
    data |= {name: ((), value) for name, value in totals.items()}
    drawn = seed.entropy if isinstance(seed, np.random.SeedSequence) else seed
    made |= {
        "release": release,
        "seed": int(drawn),
        "spawn_key": list(getattr(seed, "spawn_key", ())),
    }
    return dataset(data, {"time": times}, made, "Migration control, one run", model)


def _checked(model, longest_hold, periods, switchings, settling):
    """Check arguments of `migrate`; return the `ReleaseCase` and the parameters of the dataset."""
    model.pack()
    check_count("longest_hold", longest_hold, **PERIODS_RANGE)
    check_count("periods", periods, **PERIODS_RANGE)
    check_count("switchings", switchings, most=10**4)
    made = model.describe(settling) | {
        "longest_hold": longest_hold,
        "periods": periods,
        "largest_switchings": switchings,
    }
    return release_case(model.oscillator, model.damper, model.frequency, settling), made


def trials(
    oscillator,
    damper,
    frequency,
    *,
    trials=400,
    releases=240,
    lifetime=4000,
    seed=1995,
    longest_hold=500,
    periods=2000,
    switchings=100,
    settling=None,
    workers=1,
    progress=None,
):
    """Run the controller many times, and find the motions to which releases lead.

    After the damper is switched on, a large irregular motion comes first, the violent transient.
    The time until it settles, its life, is measured too.

    Parameters
    ----------
    oscillator, damper, frequency, longest_hold, periods, switchings, settling
        As in `migrate`.
    trials : int
        Runs of the controller.
    releases : int
        Number of releases of each damped motion, and of runs in which the life is measured.
    lifetime : int
        Largest number of forcing cycles of the runs that measure the life.

    Returns
    -------
    xarray.Dataset
        For each `trial` the results of `migrate`; the displacement is stored for one trial only,
        `example`. Shares of trials that reach the non-resonance branch. For each (damped, release)
        the free motion to which a release leads; the first damped motion is the violent transient.
        For each `run` the life of the transient, and for each `age` the share of transients that
        last longer.
    """
    settling = check_settling(settling)
    check_count("trials", trials, **RUNS_RANGE)
    check_count("releases", releases, **RUNS_RANGE)
    check_count("lifetime", lifetime, **LIFETIME_RANGE)
    check_count("seed", seed, **SEED_RANGE)
    model = read_forced(oscillator, damper, frequency, needs_damper=True)
    case, made = _checked(model, longest_hold, periods, switchings, settling)
    runs, watched = (
        root.spawn(number)
        for root, number in zip(
            np.random.SeedSequence(seed).spawn(2), (trials, releases), strict=True
        )
    )
    draws = np.array([draw(child, switchings) for child in runs])
    logs, stop = blank(draws.shape[:2]), np.zeros(1, bool)

    def work(part):
        for i in range(part.start, part.stop):
            _, logs[i] = control(case, draws[i], longest_hold, settling, periods, None, stop)

    ensemble.run_chunks(work, trials, workers, progress, stop, size=8)
    totals = run_totals(logs)
    logs = logs[:, : np.max(totals["switchings"])]
    data = switching_data(logs, case)
    example = _example(totals)
    path, log = control(case, draws[example], longest_hold, settling, periods, None)
    times, displacement = course(case, path, log, settling.tolerance)
    data |= totals | _summary(data, totals) | {"example": example, "displacement": displacement}
    lives, motions, entries = watch_runs(case, watched, lifetime, settling, workers, progress)
    life, coordinates = transient_data(lives, motions, lifetime, case.known)
    records = settled_motions(oscillator, damper, frequency, seed, settling, workers, motions)
    data |= life | release_data(case, records, entries, settling)
    coordinates |= {
        "time": times,
        "bound": BOUNDS,
        "damped_motion": KINDS,
        "free_motion": DESTINATIONS,
    }
    made |= {"trials": trials, "releases": releases, "lifetime": lifetime, "seed": seed}
    return dataset(data, coordinates, made, "Migration control")


def _example(totals):
    """Return the first run with the median number of switchings of those that arrive, or 0."""
    reached = totals["trial_outcome"] == flag("trial_outcome", "reached")
    if not reached.any():
        return 0
    middle = np.quantile(totals["switchings"][reached], 0.5, method="lower")
    return int(np.argmax(reached & (totals["switchings"] == middle)))


def _summary(logs_data, totals):
    """Return shares of all runs, and numbers of releases by the motions before and after them."""
    reached = totals["trial_outcome"] == flag("trial_outcome", "reached")
    number = len(reached)
    count = [
        [
            np.sum(
                (logs_data["released_from"] == DAMPED_MOTION[kind])
                & (logs_data["destination"] == FREE_MOTION[name])
            )
            for name in DESTINATIONS
        ]
        for kind in KINDS
    ]
    within = reached & (totals["total_time"] <= PAPER_CYCLES)
    return {
        "destination_count": np.array(count),
        "reached_share": wilson(np.sum(reached), number),
        "within_share": wilson(np.sum(within), number),
    }


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


def control(case, draws, longest_hold, settling, periods, releases, stop=NEVER):
    """Return path and log of one run of the controller.

    Parameters
    ----------
    case : ReleaseCase
    draws : array, shape (n, 3)
        Result of `draw`. A row holds the phase at which the damper is switched on, the place of the
        loose mass in the gap at this time, and the phase at which the damper is switched off. A
        phase is a fraction of the period of the motion before the switching.
    longest_hold : int
        Forcing cycles after which the damper is switched off in any case.
    settling : Settling
    periods : int
        Forcing cycles after which no further switching begins.
    releases : ReleaseSet or None
        The set for release by state; None for release from the settled motion.
    stop : array of bool, shape (1,)
        Argument of `legs.run`.

    Returns
    -------
    path : numpy.ndarray, shape (m, 5)
        One row for each strobe and each switching: forcing cycles from the first strobe, then the
        state.
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
        place = 2 * draw[1] - 1
        if releases is None:
            entry["on_time"] = leg(case.off, case.on, draw[0], place, longest_hold)
            entry["released_period"] = record["period"]
            entry["released_displacement"] = record["maximum_displacement"]
            entry["off_time"] = leg(case.on, case.off, draw[2], 0.0, settling.limit)
        else:
            wait = draw[0] * max(int(record["period"]), 1)
            held = legs.hold_by_state(
                case.off,
                case.on,
                y,
                wait,
                place,
                strobe,
                settling.tolerance,
                longest_hold,
                releases,
            )
            path.append(held[:-1])
            entry["on_time"], entry["off_time"] = held[0, 0], held[-1, 0]
            strobe = np.floor(held[-1, 0]) + 1.0
            ahead, limit = strobe - held[-1, 0], settling.limit
            legs.run_and_measure(
                case.off, y, ahead, strobe, settling.tolerance, limit, rest, records, stop
            )
            path.append(rest[: record["periods_run"] + 2].copy())
            strobe += record["periods_run"]
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
