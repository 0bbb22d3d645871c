"""Where releases of the damper lead, and how long the violent motion lives (section 5).

The damper is switched on while the free oscillator moves on its resonance branch, at a
forcing phase drawn uniformly; the loose mass is then somewhere in the gap, drawn uniformly,
at rest relative to the primary, as if a clamp had held it there.
"""

from itertools import count
from typing import NamedTuple

import numpy as np
from scipy.stats import binomtest, chi2

from impact_damper import ensemble, orbits, recording, switching
from impact_damper.datasets import dataset, flag
from impact_damper.harmonic_balance import free_solutions, impacting_solutions
from impact_damper.motions import is_settled, random_states
from impact_damper.parameters import check_count, describe, pack
from impact_damper.response import frequency_response
from impact_damper.sweep import FREQUENCY, RESOLUTION, Catalogue
from impact_damper.variables import DAMPED_MOTION, FREE_MOTION, VARIABLES

LEAD = 20
BOUNDS = ["share", "lower", "upper"]
KINDS = list(DAMPED_MOTION)[1:]
DESTINATIONS = list(FREE_MOTION)[1:]


class Scene(NamedTuple):
    """What the kernels of `switching` are given: parameters, the start, and what is known.

    Attributes
    ----------
    on, off : array, shape (7,)
    state : array, shape (4,)
        Free resonance motion at a strobe.
    known : array, shape (2,)
        max |Z1| of the free non-resonance and resonance motion.
    """

    on: np.ndarray
    off: np.ndarray
    state: np.ndarray
    known: np.ndarray


def _free_motion(oscillator, frequency, start, which, settling):
    """Period-1 motion at a frequency, followed from the harmonic balance at another, or None."""
    p = pack(oscillator, None, start)
    free = free_solutions(oscillator, start)
    angle = free.phase[which] + np.pi / 2
    primary = free.amplitude[which] * np.array([np.cos(angle), -start * np.sin(angle)])
    record = ensemble.settle(p[None], np.tile(primary, (1, 2)), settling, from_strobe=True)[0]
    if record["period"] != 1:
        return None
    y = record["state"].copy()
    orbits.follow(p, y, 1, FREQUENCY, frequency, RESOLUTION, orbits.POLISH_TOLERANCE)
    if p[FREQUENCY] != frequency:
        return None
    found = recording.measured(p, y, 1, settling.tolerance)
    found["state"] = y
    return found


def scene(oscillator, damper, frequency, settling) -> Scene:
    """The free oscillator on its resonance branch, followed upward, and its goal, downward.

    Raises
    ------
    ValueError
        If the free oscillator does not have both period-1 motions at this frequency.
    """
    on, off = pack(oscillator, damper, frequency), pack(oscillator, None, frequency)
    goal = _free_motion(oscillator, frequency, 1.1 * frequency, 0, settling)
    resonance = _free_motion(oscillator, frequency, 0.9 * frequency, -1, settling)
    known = np.array(
        [
            np.nan if record is None else record["maximum_displacement"]
            for record in (goal, resonance)
        ]
    )
    if not known[0] + switching.ALIKE < known[1]:
        raise ValueError(
            f"frequency = {frequency:g}: the free oscillator must have a non-resonance and a "
            "resonance motion here, since migration leads from one to the other"
        )
    return Scene(on, off, resonance["state"].copy(), known)


def wilson(successes, total):
    """Share, and Wilson's 95 % interval for it; NaN of nothing."""
    if total == 0:
        return np.full(3, np.nan)
    interval = binomtest(int(successes), int(total)).proportion_ci(method="wilson")
    return np.array([successes / total, interval.low, interval.high])


def survival(lives, horizon, times):
    """Share of runs that live longer than each of the times, shape (n, 3) with its interval.

    Lives beyond the horizon count only as longer than that. No run is lost earlier, so this is
    Kaplan and Meier's estimate, and each value a binomial share.

    Raises
    ------
    ValueError
        If a time lies beyond the horizon.
    """
    if np.max(times) > horizon:
        raise ValueError(f"times: must be at most the horizon {horizon}, {np.max(times)} given")
    return np.array([wilson(np.sum(lives > time), len(lives)) for time in times])


def escape_rate(lives, horizon, lead=LEAD):
    """Rate of an exponential life beyond `lead`, with its 95 % interval, per unit of time.

    Captures over time at risk, and the chi-squared limits for a Poisson count of captures.
    """
    captures = np.sum((lives > lead) & (lives <= horizon))
    exposure = np.sum(np.clip(np.minimum(lives, horizon) - lead, 0, None))
    if exposure == 0:
        return np.full(3, np.nan)
    lower = chi2.ppf(0.025, 2 * captures) / 2 if captures else 0.0
    return np.array([captures, lower, chi2.ppf(0.975, 2 * captures + 2) / 2]) / exposure


def kinds(period, displacement, known):
    """Flags of damped motions: a period-1 motion is quiet below half the resonance motion."""
    one = np.where(displacement < known[1] / 2, DAMPED_MOTION["quiet"], DAMPED_MOTION["violent"])
    several = np.where(period > 1, DAMPED_MOTION["subharmonic"], one)
    return np.where(period == 0, DAMPED_MOTION["unsettled"], several)


def watch(here, seeds, lifetime, settling, workers, progress):
    """Runs from the resonance branch, each released once: lives, records and releases."""
    draws = np.array([np.random.default_rng(seed).random(4) for seed in seeds])
    lives = np.empty(len(draws))
    motions = np.zeros(len(draws), recording.MOTION)
    entries = np.zeros(len(draws), switching.RELEASE)
    for name in ("phase", "displacement", "velocity"):
        entries[name] = np.nan
    entries["destination"] = flag("destination", "none")

    def work(part):
        switching.transients(
            here.on,
            here.off,
            here.state,
            draws[part],
            here.known,
            settling.tolerance,
            LEAD,
            lifetime,
            settling.limit,
            lives[part],
            motions[part],
            entries[part],
            np.zeros(1, recording.MOTION),
        )

    ensemble.run_chunks(work, len(draws), workers, progress)
    return lives, motions, entries


def transient_data(lives, motions, lifetime, known):
    """Registered variables of the life of transients, and its coordinate.

    A run is known to be captured only once it has settled, so the horizon is the lifetime less
    the longest time between capture and settling.
    """
    settled = is_settled(motions)
    delay = np.max(motions["periods_run"][settled] - lives[settled], initial=0)
    horizon = lifetime - delay
    times = np.arange(0, horizon + 1, 10)
    return {
        "life": np.where(lives <= horizon, lives, np.nan),
        "landing_time": np.where(settled, motions["periods_run"], np.nan),
        "landed_on": kinds(motions["period"], motions["maximum_displacement"], known),
        "survival": survival(lives, horizon, times),
        "at_risk": np.sum(lives > times[:, None], axis=1),
        "escape_rate": escape_rate(lives, horizon),
        "horizon": horizon,
    }, {"age": times}


def release_data(here, motions, entries, settling):
    """Registered variables of releases: of the unsettled motion, then of each settled one.

    Settled motions are released at as many phases as there are `entries`, evenly over the period.
    """
    number = len(entries)
    rows = [entries]
    for record in motions:
        waits = np.arange(number) * record["period"] / number
        rows.append(np.zeros(number, switching.RELEASE))
        switching.release_many(
            here.on,
            here.off,
            record["state"].copy(),
            waits,
            here.known,
            settling.tolerance,
            settling.limit,
            rows[-1],
            np.zeros(1, recording.MOTION),
        )
    table = np.array(rows)
    valid = np.sum(table["destination"] >= 0, axis=1)
    shares = [
        [wilson(np.sum(row["destination"] == FREE_MOTION[name]), total) for name in DESTINATIONS]
        for row, total in zip(table, valid, strict=True)
    ]
    period = np.array([0] + [record["period"] for record in motions])
    displacement = np.array([np.nan] + [record["maximum_displacement"] for record in motions])
    return {
        "damped_kind": kinds(period, displacement, here.known),
        "damped_period": period,
        "damped_displacement": displacement,
        "damped_contacts": np.array([np.nan] + [record["contacts"] for record in motions]),
        "release_phase": table["phase"],
        "release_displacement": table["displacement"],
        "release_velocity": table["velocity"],
        "release_destination": table["destination"],
        "release_share": np.array(shares),
    }


def settled_motions(oscillator, damper, frequency, seed, settling, workers, found):
    """The distinct settled damped motions, small ones first.

    Among `found`, from random starts within the gap, and from harmonic balance.
    """
    on = pack(oscillator, damper, frequency)
    balance = impacting_solutions(oscillator, damper, frequency)
    angle = balance.phase + np.pi / 2
    columns = [
        part
        for size in (balance.amplitude, balance.relative_amplitude)
        for part in (size * np.cos(angle), -size * frequency * np.sin(angle))
    ]
    states = np.concatenate([np.stack(columns, axis=-1), random_states(96, 2.0, damper, seed)])
    reached = ensemble.settle(
        np.tile(on, (len(states), 1)), states, settling, from_strobe=True, workers=workers
    )
    catalogue = Catalogue(on, count())
    for record in np.concatenate([found, reached]):
        if is_settled(record):
            catalogue.add(record, "random_start")
    return sorted(catalogue.records, key=lambda record: record["maximum_displacement"])


def _scan_records(response):
    """Records of the settled motions at one frequency of a frequency response."""
    keep = response["outcome"].values == flag("outcome", "settled")
    found = np.zeros(np.sum(keep), recording.MOTION)
    for name in ("period", "maximum_displacement", "contacts", "state"):
        found[name] = response[name].values[keep]
    return found[::-1]


def _padded(values, length):
    """Array with its first axis filled up to a length by what stands for nothing."""
    missing = np.full(
        (length - len(values), *values.shape[1:]),
        np.nan if values.dtype.kind == "f" else -1,
        values.dtype,
    )
    return np.concatenate([values, missing])


def release_scan(
    oscillator,
    damper,
    frequencies,
    *,
    starts=24,
    releases=100,
    lifetime=200,
    seed=1995,
    settling=None,
    workers=1,
    progress=None,
):
    """Where releases lead from every damped motion, at each frequency.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequencies : sequence of float
        Increasing forcing frequencies at which both free period-1 motions exist.
    starts : int
        Random starts a frequency; the motions found are followed in frequency as well.
    releases : int
        Releases of each motion.
    lifetime : int
        Forcing periods within which the motion that has not settled is released.
    seed : int
    settling : Settling, optional
    workers, progress
        As in `response.frequency_response`.

    Returns
    -------
    xarray.Dataset
        Over (frequency, damped) the damped motions, first the one that has not settled, and
        over (frequency, damped, free_motion, bound) the shares of their releases.

    Raises
    ------
    ValueError
        If the free oscillator has not both motions at a frequency, or an argument is out of range.
    """
    settling = settling or ensemble.Settling()
    check_count("releases", releases, most=10**6)
    check_count("lifetime", lifetime, least=2 * LEAD, most=10**7)
    scenes = [scene(oscillator, damper, frequency, settling) for frequency in frequencies]
    response = frequency_response(
        oscillator,
        damper,
        frequencies,
        starts=starts,
        seed=seed,
        settling=settling,
        workers=workers,
        progress=progress,
    )
    seeds = np.random.SeedSequence(seed).spawn(len(scenes))
    rows = []
    for i, here in enumerate(scenes):
        _, _, entries = watch(here, seeds[i].spawn(releases), lifetime, settling, workers, None)
        rows.append(
            release_data(here, _scan_records(response.isel(frequency=i)), entries, settling)
        )
    width = max(len(row["damped_kind"]) for row in rows)
    names = (
        "damped_kind",
        "damped_period",
        "damped_displacement",
        "damped_contacts",
        "release_share",
    )
    data = {name: np.array([_padded(row[name], width) for row in rows]) for name in names}
    data = {name: (("frequency", *VARIABLES[name].dims), values) for name, values in data.items()}
    made = describe(oscillator, damper, settling) | {
        "starts": starts,
        "releases": releases,
        "lifetime": lifetime,
        "seed": seed,
    }
    coordinates = {
        "frequency": response["frequency"].values,
        "free_motion": DESTINATIONS,
        "bound": BOUNDS,
    }
    return dataset(data, coordinates, made, "Where releases of the damper lead")
