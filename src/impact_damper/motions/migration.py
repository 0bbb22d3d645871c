"""Migration control: the controller of figure 17, from the resonance to the non-resonance branch.

Without the damper (free) the oscillator has a large motion on its resonance branch and a small one
on its non-resonance branch. The controller switches the damper on and off (release) until the
oscillator changes from the large to the small motion. See `migration.controller`.
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
)
from impact_damper.model.names import names_arguments
from impact_damper.model.settling import check_settling
from impact_damper.motions import ensemble
from impact_damper.motions.controller import (
    blank,
    control,
    course,
    draw,
    run_totals,
    switching_data,
)
from impact_damper.motions.releases import (
    DESTINATIONS,
    KINDS,
    release_case,
    release_data,
    settled_motions,
    transient_data,
    watch_runs,
)

# Number of cycles within which, by the paper, its controller reaches the non-resonance branch.
PAPER_CYCLES = 350


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


@names_arguments
def migrate(
    system,
    damper,
    frequency,
    *,
    seed=1995,
    longest_hold=500,
    periods=2000,
    switchings=100,
    settling=None,
):
    """Switch the damper on and off until the free oscillator is on its small motion.

    This is one run of the controller of figure 17 of the paper, from the resonance branch. The
    damper is on until the motion has settled, then off until the free motion has settled, and so
    on.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper or MachineDamper
    frequency : float
        Forcing frequency W, or Hz for a machine; both free motions of period 1 must exist there.
    seed : int or numpy.random.SeedSequence
        Seed of the switching phases and of the places of the loose mass.
    longest_hold : int
        Forcing cycles after which the damper is switched off even if the motion has not settled.
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
    path, log = control(case, draw(seed, switchings), longest_hold, settling, periods)
    totals = run_totals(log)
    log = log[: totals["switchings"]]
    times, displacement = course(case, path, log, settling.tolerance)
    data = {"displacement": displacement}
    data |= {name: ("switching", values) for name, values in switching_data(log, case).items()}
    data |= {name: ((), value) for name, value in totals.items()}
    drawn = seed.entropy if isinstance(seed, np.random.SeedSequence) else seed
    made |= {"seed": int(drawn), "spawn_key": list(getattr(seed, "spawn_key", ()))}
    return dataset(data, {"time": times}, made, "Migration control, one run", model)


def _example(totals):
    """Return the index of the run to be drawn: the first with the median number of switchings.

    Only runs that reach the non-resonance branch are considered. Return 0 if none does.
    """
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
    seed : int
    workers : int
        Threads; the result does not depend on it.
    progress : str, optional
        Title of a progress bar.

    Returns
    -------
    xarray.Dataset
        For each `trial` the results of `migrate`; the displacement is stored for one trial only,
        `example`. Shares of trials that reach the non-resonance branch. For each (damped, release)
        the free motion to which a release leads; the first damped motion is the violent transient.
        For each `run` the life of the transient, and for each `age` the share of transients that
        last longer.

    Raises
    ------
    ValueError
        If the free oscillator lacks one of its two motions of period 1, or an argument is out of
        range.
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
