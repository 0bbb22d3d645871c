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
from impact_damper.parameters import check_count, describe
from impact_damper.releases import (
    BOUNDS,
    DESTINATIONS,
    KINDS,
    kinds,
    release_data,
    scene,
    settled_motions,
    transient_data,
    watch,
    wilson,
)
from impact_damper.variables import DAMPED_MOTION, FREE_MOTION

PAPER_CYCLES = 350
LEAD = 10
SAMPLES = 40


def _draws(seed, switchings):
    """Phases and places of one run: the first rows are the same for any number of switchings."""
    return np.random.default_rng(seed).random((switchings, 3))


def _control(here, draws, longest_hold, settling, periods):
    """Runs for draws (n, m, 3): path of the last, logs (n, m) and counts of switchings (n,)."""
    number, switchings = draws.shape[:2]
    # a run may end after `periods` by a hold, a settling and their waits
    path = np.empty((periods + longest_hold + settling.limit + 4 * switchings + 100, 5))
    logs = np.zeros((number, switchings), switching.SWITCHING)
    counts = np.zeros(number, int)
    rows = switching.control_many(
        here.on,
        here.off,
        here.state,
        draws,
        here.known,
        settling.tolerance,
        longest_hold,
        settling.limit,
        periods,
        path,
        logs,
        counts,
        np.zeros(1, recording.MOTION),
    )
    return path[:rows], logs, counts


def _trace(here, path, log, tolerance):
    """Times T and Z1 along a run, from LEAD periods before its first strobe to LEAD after its end.

    Each stretch between two rows of the path is integrated by itself, so that a chaotic motion
    is the very one that was controlled.
    """
    period = 2 * np.pi / here.on[0]
    path = np.vstack([np.append(-LEAD, here.state), path])
    ends = np.append(path[1:, 0], path[-1, 0] + LEAD)
    times = np.arange(-LEAD * SAMPLES, int(ends[-1] * SAMPLES)) / SAMPLES
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


def _log_data(logs, counts, here):
    """Registered variables of each switching, over (..., switching), absent ones marked."""
    absent = np.arange(logs.shape[-1]) >= np.asarray(counts)[..., None]
    period = 2 * np.pi / here.on[0]
    kind = kinds(logs["released_period"], logs["released_displacement"], here.known)
    data = {
        name: np.where(absent, np.nan, (logs[name] + 0.25) * period)
        for name in ("on_time", "off_time", "end_time")
    }
    data |= {
        name: np.where(absent, np.nan, logs[name])
        for name in ("released_displacement", "destination_displacement")
    }
    return data | {
        "released_from": np.where(absent, DAMPED_MOTION["none"], kind),
        "released_period": np.where(absent, 0, logs["released_period"]),
        "destination": np.where(absent, FREE_MOTION["none"], logs["destination"]),
    }


def _totals(logs, counts):
    """Registered variables of whole runs, in forcing periods from the first switching."""
    absent = np.arange(logs.shape[-1]) >= np.asarray(counts)[..., None]
    last = np.asarray(counts)[..., None] - 1

    def final(name):
        return np.take_along_axis(logs[name], last, axis=-1)[..., 0]

    first = logs["on_time"][..., 0]
    held = np.where(absent, 0.0, logs["off_time"] - logs["on_time"])
    reached = final("destination") == FREE_MOTION["non_resonance"]
    return {
        "trial_outcome": np.where(
            reached, flag("trial_outcome", "reached"), flag("trial_outcome", "not_reached")
        ),
        "switchings": np.asarray(counts),
        "damper_time": np.sum(held, axis=-1),
        "release_time": final("off_time") - first,
        "total_time": final("end_time") - first,
    }


def _checked(oscillator, damper, frequency, longest_hold, periods, switchings, settling):
    """The scene, and the parameters of the dataset, or an error that names a bad argument."""
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
    settling = settling or ensemble.Settling()
    here, made = _checked(
        oscillator, damper, frequency, longest_hold, periods, switchings, settling
    )
    path, logs, counts = _control(
        here, _draws(seed, switchings)[None], longest_hold, settling, periods
    )
    log = logs[0, : counts[0]]
    times, displacement = _trace(here, path, log, settling.tolerance)
    data = {"displacement": displacement}
    data |= {
        name: ("switching", values) for name, values in _log_data(log, counts[0], here).items()
    }
    data |= {name: ((), values) for name, values in _totals(log, counts[0]).items()}
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
    settling = settling or ensemble.Settling()
    check_count("trials", trials, most=10**6)
    check_count("releases", releases, most=10**6)
    check_count("lifetime", lifetime, least=100, most=10**7)
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
    logs = np.zeros(draws.shape[:2], switching.SWITCHING)
    counts = np.zeros(trials, int)

    def work(part):
        _, logs[part], counts[part] = _control(here, draws[part], longest_hold, settling, periods)

    ensemble.run_chunks(work, trials, workers, progress)
    logs = logs[:, : np.max(counts)]
    data = _log_data(logs, counts, here)
    totals = _totals(logs, counts)
    example = _example(totals)
    path, _, _ = _control(here, draws[example, None], longest_hold, settling, periods)
    times, displacement = _trace(here, path, logs[example, : counts[example]], settling.tolerance)
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
