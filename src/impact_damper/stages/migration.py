"""Migration control: the controller of figure 17, from resonance to non-resonance branch."""

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.data.shares import BOUNDS, wilson
from impact_damper.data.variables.variable import DAMPED_MOTION, FREE_MOTION
from impact_damper.migration.controller import (
    blank,
    control,
    course,
    draw,
    run_totals,
    switching_data,
)
from impact_damper.migration.damper_release import (
    DESTINATIONS,
    KINDS,
    release_case,
    release_data,
    settled_motions,
    transient_data,
    watch_runs,
)
from impact_damper.motions import ensemble
from impact_damper.system.bounds import (
    LIFETIME_RANGE,
    PERIODS_RANGE,
    RUNS_RANGE,
    SEED_RANGE,
    check_count,
)
from impact_damper.system.packed import pack
from impact_damper.system.parameters import check_damper, describe
from impact_damper.system.settling import check_settling

# Forcing periods within which the paper's controller reaches the goal.
PAPER_CYCLES = 350


def _checked(oscillator, damper, frequency, longest_hold, periods, switchings, settling):
    """Return the case and the parameters of the dataset, or raise for a bad argument."""
    check_damper(damper)
    pack(oscillator, damper, frequency)
    check_count("longest_hold", longest_hold, **PERIODS_RANGE)
    check_count("periods", periods, **PERIODS_RANGE)
    check_count("switchings", switchings, most=10**4)
    made = describe(oscillator, damper, settling) | {
        "frequency": float(frequency),
        "longest_hold": longest_hold,
        "periods": periods,
        "largest_switchings": switchings,
    }
    return release_case(oscillator, damper, frequency, settling), made


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
    """Run the controller of figure 17 once, from the resonance branch.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
        Forcing frequency at which both free period-1 motions exist, dimensionless.
    seed : int or numpy.random.SeedSequence
        Seed of the switching phases and of the places of the loose mass.
    longest_hold : int
        Forcing periods after which the damper is switched off though its motion has not settled.
    periods : int
        Forcing periods after which no switching begins.
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
        check_count("seed", seed, **SEED_RANGE)
    case, made = _checked(
        oscillator, damper, frequency, longest_hold, periods, switchings, settling
    )
    path, log = control(case, draw(seed, switchings), longest_hold, settling, periods)
    totals = run_totals(log)
    log = log[: totals["switchings"]]
    times, displacement = course(case, path, log, settling.tolerance)
    data = {"displacement": displacement}
    data |= {name: ("switching", values) for name, values in switching_data(log, case).items()}
    data |= {name: ((), value) for name, value in totals.items()}
    return dataset(data, {"time": times}, made, "Migration control, one run")


def _example(totals):
    """Return the first run with the median number of switchings of the runs that reach the goal."""
    reached = totals["trial_outcome"] == flag("trial_outcome", "reached")
    if not reached.any():
        return 0
    middle = np.quantile(totals["switchings"][reached], 0.5, method="lower")
    return int(np.argmax(reached & (totals["switchings"] == middle)))


def _summary(logs_data, totals):
    """Return registered shares and counts over all runs."""
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
    """Run the controller many times, release damped motions, and time the violent motion.

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
    check_count("trials", trials, **RUNS_RANGE)
    check_count("releases", releases, **RUNS_RANGE)
    check_count("lifetime", lifetime, **LIFETIME_RANGE)
    check_count("seed", seed, **SEED_RANGE)
    case, made = _checked(
        oscillator, damper, frequency, longest_hold, periods, switchings, settling
    )
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
            _, logs[i] = control(case, draws[i], longest_hold, settling, periods, stop)

    ensemble.run_chunks(work, trials, workers, progress, stop, size=8)
    totals = run_totals(logs)
    logs = logs[:, : np.max(totals["switchings"])]
    data = switching_data(logs, case)
    example = _example(totals)
    path, log = control(case, draws[example], longest_hold, settling, periods)
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
