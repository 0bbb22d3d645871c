"""Motions to which releases of the damper lead, and lifetimes of the violent motion (section 5).

The damper is switched on during the resonance motion, at a random phase, with the loose mass at
rest relative to the primary mass at a random place in the gap, as if a clamp had held it. Then the
motion can be irregular for many cycles, its lifetime, before it settles to a periodic orbit. A
release switches the damper off again, so that the free motion settles.
"""

from dataclasses import replace
from itertools import count
from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import is_settled
from impact_damper.data.shares import escape_rate, survival, wilson
from impact_damper.data.variables import DAMPED_MOTION, FREE_MOTION
from impact_damper.model.bounds import FREQUENCY_RANGE, LEAD
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.motions import ensemble, legs
from impact_damper.motions.following import record_at
from impact_damper.motions.records import MOTION, NEVER
from impact_damper.motions.simulate import random_states
from impact_damper.motions.sweep import Catalogue
from impact_damper.theory.free_oscillator import main_solutions
from impact_damper.theory.single_harmonic import impacting_solutions

# Two free motions are the same if their max |Z1| differs by less than ALIKE.
ALIKE = 1e-6
# One release: phase in forcing cycles after a strobe, Z1 and Z1', and the flag of the free motion
# to which the release leads.
RELEASE = np.dtype(
    [("phase", "f8"), ("displacement", "f8"), ("velocity", "f8"), ("destination", "i1")]
)
# Names of the kinds of motion with the damper and without, except the first name, "none".
KINDS = list(DAMPED_MOTION)[1:]
DESTINATIONS = list(FREE_MOTION)[1:]


class ReleaseCase(NamedTuple):
    """Parameters, first state and known free motions for releases at one frequency.

    `on` and `off` are packed parameters with and without the damper, `state` is the free resonance
    motion at a strobe, and `known` the max |Z1| of the free non-resonance motion and of the
    resonance motion.
    """

    on: np.ndarray
    off: np.ndarray
    state: np.ndarray
    known: np.ndarray


def _free_motion(oscillator, frequency, start, which, settling):
    """Return the record of a free motion of period 1 at a frequency, or None.

    At the frequency `start` a run begins with the state of the harmonic-balance solution number
    `which`, by ascending amplitude, and settles. From there the motion is followed to `frequency`.
    """
    p = pack(oscillator, None, start)
    free = main_solutions(oscillator, start)
    angle = free.phase[which] + np.pi / 2
    primary = free.amplitude[which] * np.array([np.cos(angle), -start * np.sin(angle)])
    record = ensemble.settle(p[None], np.tile(primary, (1, 2)), settling, from_strobe=True)[0]
    if record["period"] != 1:
        return None
    return record_at(p, record["state"], 1, FREQUENCY, frequency, settling.tolerance)


def release_case(oscillator, damper, frequency, settling) -> ReleaseCase:
    """Return the `ReleaseCase` of a damper at a frequency.

    With a hardening spring the resonance motion ends at a fold at a higher frequency, and the
    non-resonance motion, the goal of migration, at a fold at a lower frequency. Therefore the
    resonance motion is followed upward in frequency and the non-resonance motion downward. With a
    softening spring both directions are reversed.

    Raises
    ------
    ValueError
        If the free oscillator does not have both period-1 motions at this frequency.
    """
    on, off = pack(oscillator, damper, frequency), pack(oscillator, None, frequency)
    above = min(1.1 * frequency, FREQUENCY_RANGE["most"])
    below = max(0.9 * frequency, FREQUENCY_RANGE["least"])
    ends = (above, below) if oscillator.hardening >= 0 else (below, above)
    goal = _free_motion(oscillator, frequency, ends[0], 0, settling)
    resonance = _free_motion(oscillator, frequency, ends[1], -1, settling)
    known = np.array(
        [
            np.nan if record is None else record["maximum_displacement"]
            for record in (goal, resonance)
        ]
    )
    if not known[0] + ALIKE < known[1]:
        told = oscillator.scales.told("frequency", frequency, "frequency")
        raise ValueError(
            f"{told}: without the damper there must be both a non-resonance and a resonance "
            "motion, since migration leads from one to the other (a linear spring has only one "
            "motion)"
        )
    return ReleaseCase(on, off, resonance["state"].copy(), known)


def kinds(period, displacement, known):
    """Return flags (`DAMPED_MOTION`) that classify motions by period and max |Z1|, arrays.

    A motion of period 1 is quiet if its max |Z1| is below half the max |Z1| of the free resonance
    motion.
    """
    one = np.where(displacement < known[1] / 2, DAMPED_MOTION["quiet"], DAMPED_MOTION["violent"])
    several = np.where(period > 1, DAMPED_MOTION["subharmonic"], one)
    return np.where(period == 0, DAMPED_MOTION["unsettled"], several)


def destination(known, record):
    """Return the flag (`FREE_MOTION`) that names the free motion in a record."""
    if not is_settled(record):
        return FREE_MOTION["unresolved"]
    if record["period"] == 3:
        return FREE_MOTION["subharmonic"]
    for name, displacement in zip(("non_resonance", "resonance"), known, strict=True):
        if record["period"] == 1 and abs(record["maximum_displacement"] - displacement) < ALIKE:
            return FREE_MOTION[name]
    return FREE_MOTION["other"]


def _release(case, state, wait, settling, path, entry, stop=NEVER):
    """Switch the damper off `wait` forcing cycles after a strobe, and fill `entry`, a RELEASE."""
    records = np.zeros(1, MOTION)
    legs.leg(
        case.on,
        case.off,
        state.copy(),
        wait,
        0.0,
        0.0,
        settling.tolerance,
        settling.limit,
        path,
        records,
        stop,
    )
    entry["phase"], entry["displacement"], entry["velocity"] = wait, path[0, 1], path[0, 2]
    entry["destination"] = destination(case.known, records[0])


def _watch_one(case, draws, lifetime, settling, path, records, entry, stop):
    """Run with the damper on, release once, and return the lifetime in forcing cycles.

    `draws` are four numbers between 0 and 1: the phase at which the damper is switched on, the
    place of the loose mass, the strobe of the release, and the phase after this strobe. The strobe
    of the release lies between strobe LEAD, before which the run still depends on its start, and
    the capture by an orbit, which ends the lifetime. A run that is captured before strobe LEAD is
    not released.
    """
    legs.leg(
        case.off,
        case.on,
        case.state.copy(),
        draws[0],
        2 * draws[1] - 1,
        0.0,
        settling.tolerance,
        lifetime,
        path,
        records,
        stop,
    )
    life = lifetime
    if is_settled(records[0]):
        life = legs.life(case.on, path, records[0], settling.tolerance)
    if life > LEAD:
        k = LEAD + int(draws[2] * (life - LEAD))
        rest = np.empty((settling.limit + 2, 5))
        _release(case, path[k + 1, 1:], draws[3], settling, rest, entry, stop)
    return life


def watch_runs(case, seeds, lifetime, settling, workers, progress):
    """Run with the damper on from the resonance branch, and release each run once.

    Return for each of the `seeds` (SeedSequence) the forcing cycles before the run is captured by
    an orbit (`legs.CAPTURE`), at most `lifetime`; the record of the motion that it settles to; and
    the RELEASE.
    """
    draws = np.array([np.random.default_rng(seed).random(4) for seed in seeds])
    lives = np.empty(len(draws))
    motions = np.zeros(len(draws), MOTION)
    entries = np.zeros(len(draws), RELEASE)
    for name in ("phase", "displacement", "velocity"):
        entries[name] = np.nan
    entries["destination"] = FREE_MOTION["none"]
    stop = np.zeros(1, bool)

    def work(part):
        path = np.empty((lifetime + 2, 5))
        for i in range(part.start, part.stop):
            motion = motions[i : i + 1]
            lives[i] = _watch_one(
                case, draws[i], lifetime, settling, path, motion, entries[i], stop
            )

    ensemble.run_chunks(work, len(draws), workers, progress, stop, size=8)
    return lives, motions, entries


def transient_data(lives, motions, lifetime, known):
    """Return a dict of dataset variables of the lifetimes, and a dict with their coordinate `age`.

    A capture is detected only after the run has settled, so a run that was captured shortly before
    its end is not counted as captured. To avoid a bias, lifetimes are evaluated only up to a
    horizon: `lifetime` minus the longest time between capture and settling in any run.
    """
    settled = is_settled(motions)
    delay = np.max(motions["periods_run"][settled] - lives[settled], initial=0)
    horizon = lifetime - delay
    times = np.arange(0, horizon + 1, 10)
    return {
        "life": np.where(lives <= horizon, lives, np.nan),
        "landed_on": kinds(motions["period"], motions["maximum_displacement"], known),
        "survival": survival(lives, horizon, times),
        "escape_rate": escape_rate(lives, horizon),
        "horizon": horizon,
    }, {"age": times}


def release_data(case, motions, entries, settling):
    """Return a dict of dataset variables of the releases from the unsettled and settled motions.

    `entries` are the releases from the unsettled motion, and `motions` the settled motions, each
    with equally many releases, spread evenly over its period. While the loose mass flies, the
    primary mass moves as without the damper, so all releases within one flight lead to the same
    free motion.
    """
    number = len(entries)
    rows = [entries]
    path = np.empty((settling.limit + 2, 5))
    for record in motions:
        rows.append(np.zeros(number, RELEASE))
        for k, entry in enumerate(rows[-1]):
            wait = k * record["period"] / number
            _release(case, record["state"], wait, settling, path, entry)
    table = np.array(rows)
    valid = np.sum(table["destination"] >= 0, axis=1)
    shares = [
        [wilson(np.sum(row["destination"] == FREE_MOTION[name]), total) for name in DESTINATIONS]
        for row, total in zip(table, valid, strict=True)
    ]
    period = np.array([0] + [record["period"] for record in motions])
    displacement = np.array([np.nan] + [record["maximum_displacement"] for record in motions])
    return {
        "damped_kind": kinds(period, displacement, case.known),
        "damped_period": period,
        "damped_displacement": displacement,
        "damped_contacts": np.array([np.nan] + [record["contacts"] for record in motions]),
        "release_phase": table["phase"],
        "release_displacement": table["displacement"],
        "release_velocity": table["velocity"],
        "release_destination": table["destination"],
        "release_share": np.array(shares),
    }


def settled_motions(oscillator, damper, frequency, seed, settling, workers, known):
    """Return records of the distinct settled damped motions, by ascending max |Z1|.

    They are the settled motions among the records `known`, and those to which runs lead from random
    states with the loose mass in the gap and from solutions of harmonic balance.
    """
    on = pack(oscillator, damper, frequency)
    # Harmonic balance is solved for elastic contact. As first states of runs these solutions also
    # serve for an inelastic damper.
    balance = impacting_solutions(oscillator, replace(damper, restitution=1.0), frequency)
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
    for record in np.concatenate([known, reached]):
        if is_settled(record):
            catalogue.add(record, "random_start")
    return sorted(catalogue.records, key=lambda record: record["maximum_displacement"])
