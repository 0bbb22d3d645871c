"""Migration control: the loop of figure 17, which leads the free oscillator to its goal.

From the resonance branch the damper is switched on and off again, until the free oscillator
settles on its non-resonance branch. See `releases` for how the damper is switched on. It is
switched off in the forcing periods after its motion is recognised as settled, near a stable
orbit, at a phase drawn uniformly over the period of that motion; or, if it has not settled
within a longest hold, in the forcing period after that.
"""

import numpy as np

from impact_damper import ensemble, recording, switching
from impact_damper.datasets import dataset, flag
from impact_damper.motions import MOST_SEED, check_settling
from impact_damper.parameters import check_count, check_damper, describe, pack
from impact_damper.releases import (
    DESTINATIONS,
    KINDS,
    destination,
    kinds,
    release_data,
    scene,
    settled_motions,
    transient_data,
    watch,
)
from impact_damper.survival import BOUNDS, wilson
from impact_damper.variables.variable import DAMPED_MOTION, FREE_MOTION

PAPER_CYCLES = 350
MARGIN = 10
SAMPLES = 40
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


def _draws(seed, switchings):
    """Phases and places of one run: the first rows are the same for any number of switchings."""
    return np.random.default_rng(seed).random((switchings, 3))


def _blank(shape):
    """Log of switchings that are not made."""
    log = np.zeros(shape, SWITCHING)
    for name in SWITCHING.names:
        if SWITCHING[name].kind == "f":
            log[name] = np.nan
    log["destination"] = FREE_MOTION["none"]
    return log


def _control(here, draws, longest_hold, settling, periods):
    """One run of the controller: rows of its path, and its log.

    A row of `draws` holds for one switching the phase of switching on, the place of the loose
    mass and the phase of release, phases as a share of the period of the motion before. A row of
    the path is (forcing periods from the first strobe, state), at each strobe and switching.
    """
    y = here.state.copy()
    record = np.zeros(1, recording.MOTION)[0]
    record["period"] = 1
    log = _blank(len(draws))
    rest = np.empty((max(longest_hold, settling.limit) + 2, 5))
    path, strobe = [], 0.0

    def leg(before, after, phase, place, limit):
        nonlocal strobe
        wait = phase * max(int(record["period"]), 1)
        instant = strobe + wait
        strobe = switching.leg(
            before, after, y, wait, place, strobe, settling.tolerance, limit, rest, record
        )
        path.append(rest[: record["periods_run"] + 2].copy())
        return instant

    for entry, draw in zip(log, draws, strict=True):
        entry["on_time"] = leg(here.off, here.on, draw[0], 2 * draw[1] - 1, longest_hold)
        entry["released_period"] = record["period"]
        entry["released_displacement"] = record["maximum_displacement"]
        entry["off_time"] = leg(here.on, here.off, draw[2], 0.0, settling.limit)
        entry["end_time"] = strobe
        entry["destination"] = destination(here.known, record)
        entry["destination_displacement"] = record["maximum_displacement"]
        if entry["destination"] == FREE_MOTION["non_resonance"] or strobe >= periods:
            break
    return np.concatenate(path), log


def _trace(here, path, log, tolerance):
    """Times T and Z1 along a run, and MARGIN periods before its first strobe and after its end.

    Each stretch between two rows of the path is integrated by itself, so that a chaotic motion
    is the very one that was controlled.
    """
    period = 2 * np.pi / here.on[0]
    path = np.vstack([np.append(-MARGIN, here.state), path])
    ends = np.append(path[1:, 0], path[-1, 0] + MARGIN)
    times = np.arange(-MARGIN * SAMPLES, int(ends[-1] * SAMPLES)) / SAMPLES
    log = log[log["destination"] != FREE_MOTION["none"]]
    switched = np.stack([log["on_time"], log["off_time"]], axis=-1).ravel()
    damped = np.searchsorted(switched, (path[:, 0] + ends) / 2) % 2 == 1
    cuts = np.searchsorted(times, np.append(path[:, 0], ends[-1]))
    states = np.empty((len(times), 4))
    for row, on, first, last in zip(path, damped, cuts, cuts[1:], strict=False):
        recording.trace(
            here.on if on else here.off,
            row[1:].copy(),
            (row[0] + 0.25) * period,
            (times[first:last] + 0.25) * period,
            tolerance,
            states[first:last],
            np.empty((0, 5)),
        )
    return (times + 0.25) * period, states[:, 0]


def _log_data(logs, here):
    """Registered variables of each switching, over (..., switching)."""
    period = 2 * np.pi / here.on[0]
    kind = kinds(logs["released_period"], logs["released_displacement"], here.known)
    absent = logs["destination"] == FREE_MOTION["none"]
    data = {name: (logs[name] + 0.25) * period for name in ("on_time", "off_time", "end_time")}
    data["released_from"] = np.where(absent, DAMPED_MOTION["none"], kind)
    return data | {name: logs[name] for name in SWITCHING.names[3:]}


def _totals(logs):
    """Registered variables of whole runs, in forcing periods from the first switching."""
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


def _checked(oscillator, damper, frequency, longest_hold, periods, switchings, settling):
    """The scene, and the parameters of the dataset, or an error that names a bad argument."""
    check_damper(damper)
    pack(oscillator, damper, frequency)
    check_count("longest_hold", longest_hold, most=10**6)
    check_count("periods", periods, most=10**6)
    check_count("switchings", switchings, most=10**4)
    made = describe(oscillator, damper, settling) | {
        "frequency": float(frequency),
        "longest_hold": longest_hold,
        "periods": periods,
        "largest_switchings": switchings,
    }
    return scene(oscillator, damper, frequency, settling), made


def migrate(
    oscillator,
    damper,
    frequency,
    *,
    seed=1995,
    longest_hold=500,
    periods=2000,
    switchings=100,
    settling=None,
):
    """One run of the controller of figure 17, from the resonance branch.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
        Forcing frequency at which both free period-1 motions exist, dimensionless.
    seed : int or numpy.random.SeedSequence
        Of the switching phases and of the places of the loose mass.
    longest_hold : int
        Forcing periods after which the damper is switched off though its motion has not settled.
    periods : int
        Forcing periods after which no switching begins any more.
    switchings : int
        Largest number of switchings.
    settling : Settling, optional
        Its `tolerance` and, for the free oscillator, its `limit` are used.

    Returns
    -------
    xarray.Dataset
        Over `time` (T, dimensionless) the displacement of the primary; over `switching` the
        instants T of switching on and off and of the end of the free run, the damped motion
        released from and the free one reached; and the totals of the run in forcing periods.

    Raises
    ------
    ValueError
        If the free oscillator has not both period-1 motions, or an argument is out of range.
    """
    settling = check_settling(settling)
    if not isinstance(seed, np.random.SeedSequence):
        check_count("seed", seed, least=0, most=MOST_SEED)
    here, made = _checked(
        oscillator, damper, frequency, longest_hold, periods, switchings, settling
    )
    path, log = _control(here, _draws(seed, switchings), longest_hold, settling, periods)
    totals = _totals(log)
    log = log[: totals["switchings"]]
    times, displacement = _trace(here, path, log, settling.tolerance)
    data = {"displacement": displacement}
    data |= {name: ("switching", values) for name, values in _log_data(log, here).items()}
    data |= {name: ((), value) for name, value in totals.items()}
    return dataset(data, {"time": times}, made, "Migration control, one run")


def _example(totals):
    """The first run whose number of switchings is the lower median of those that arrive."""
    reached = totals["trial_outcome"] == flag("trial_outcome", "reached")
    if not reached.any():
        return 0
    middle = np.quantile(totals["switchings"][reached], 0.5, method="lower")
    return int(np.argmax(reached & (totals["switchings"] == middle)))


def _summary(logs_data, totals):
    """Registered shares and counts over all runs."""
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
    """Many runs of the controller, where releases lead, and the life of the violent motion.

    Parameters
    ----------
    oscillator, damper, frequency, longest_hold, periods, switchings, settling
        As in `migrate`.
    trials : int
        Runs of the controller.
    releases : int
        Releases of each damped motion, and runs watched for the life of the violent one.
    lifetime : int
        Forcing periods for which these are watched.
    seed : int
    workers : int
        Threads; the result does not depend on it.
    progress : str, optional
        Title of a progress bar.

    Returns
    -------
    xarray.Dataset
        As of `migrate` with a dimension `trial`, and the trace of the run `example`; shares that
        arrive; over (damped, release) where releases of each damped motion lead, the first
        row being the motion before it settles; over `run` the life of that motion, and over
        `age` its survival.

    Raises
    ------
    ValueError
        If the free oscillator has not both period-1 motions, or an argument is out of range.
    """
    settling = check_settling(settling)
    check_count("trials", trials, most=10**6)
    check_count("releases", releases, most=10**6)
    check_count("lifetime", lifetime, least=100, most=10**7)
    check_count("seed", seed, least=0, most=MOST_SEED)
    here, made = _checked(
        oscillator, damper, frequency, longest_hold, periods, switchings, settling
    )
    runs, watched = (
        root.spawn(number)
        for root, number in zip(
            np.random.SeedSequence(seed).spawn(2), (trials, releases), strict=True
        )
    )
    draws = np.array([_draws(child, switchings) for child in runs])
    logs = _blank(draws.shape[:2])

    def work(part):
        for i in range(part.start, part.stop):
            _, logs[i] = _control(here, draws[i], longest_hold, settling, periods)

    ensemble.run_chunks(work, trials, workers, progress)
    totals = _totals(logs)
    logs = logs[:, : np.max(totals["switchings"])]
    data = _log_data(logs, here)
    example = _example(totals)
    path, log = _control(here, draws[example], longest_hold, settling, periods)
    times, displacement = _trace(here, path, log, settling.tolerance)
    data |= totals | _summary(data, totals) | {"example": example, "displacement": displacement}
    lives, motions, entries = watch(here, watched, lifetime, settling, workers, progress)
    life, coordinates = transient_data(lives, motions, lifetime, here.known)
    records = settled_motions(oscillator, damper, frequency, seed, settling, workers, motions)
    data |= life | release_data(here, records, entries, settling)
    coordinates |= {
        "time": times,
        "bound": BOUNDS,
        "damped_motion": KINDS,
        "free_motion": DESTINATIONS,
    }
    made |= {"trials": trials, "releases": releases, "lifetime": lifetime, "seed": seed}
    return dataset(data, coordinates, made, "Migration control")
