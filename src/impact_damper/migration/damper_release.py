"""Where releases of the damper lead, and how long the violent motion lives (section 5).

The damper is switched on while the free oscillator moves on its resonance branch, at a
forcing phase drawn uniformly; the loose mass is then somewhere in the gap, drawn uniformly,
at rest relative to the primary, as if a clamp had held it there.
"""

from dataclasses import replace
from itertools import count
from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import is_settled
from impact_damper.data.shares import LEAD, escape_rate, survival, wilson
from impact_damper.data.variables.variable import DAMPED_MOTION, FREE_MOTION
from impact_damper.migration import legs
from impact_damper.motions import ensemble
from impact_damper.motions.following import record_at
from impact_damper.motions.records import MOTION
from impact_damper.motions.simulate import random_states
from impact_damper.motions.sweep import Catalogue
from impact_damper.system.bounds import FREQUENCY_RANGE
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.theory.free_oscillator import free_solutions
from impact_damper.theory.single_harmonic import impacting_solutions

ALIKE = 1e-6
RELEASE = np.dtype(
    [("phase", "f8"), ("displacement", "f8"), ("velocity", "f8"), ("destination", "i1")]
)
KINDS = list(DAMPED_MOTION)[1:]
DESTINATIONS = list(FREE_MOTION)[1:]


class ReleaseCase(NamedTuple):
    """Arguments of the kernels of `legs`: parameters, the start, and the known free motions.

    Attributes
    ----------
    on, off : array, shape (packed.COUNT,)
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
    return record_at(p, record["state"], 1, FREQUENCY, frequency, settling.tolerance)


def release_case(oscillator, damper, frequency, settling) -> ReleaseCase:
    """Return the free oscillator on its resonance branch, followed upward, and the goal of release.

    The goal is the non-resonance motion, followed downward.

    Raises
    ------
    ValueError
        If the free oscillator does not have both period-1 motions at this frequency.
    """
    on, off = pack(oscillator, damper, frequency), pack(oscillator, None, frequency)
    above = min(1.1 * frequency, FREQUENCY_RANGE["most"])
    below = max(0.9 * frequency, FREQUENCY_RANGE["least"])
    goal = _free_motion(oscillator, frequency, above, 0, settling)
    resonance = _free_motion(oscillator, frequency, below, -1, settling)
    known = np.array(
        [
            np.nan if record is None else record["maximum_displacement"]
            for record in (goal, resonance)
        ]
    )
    if not known[0] + ALIKE < known[1]:
        raise ValueError(
            f"frequency = {frequency:g}: the free oscillator must have a non-resonance and a "
            "resonance motion here, since migration leads from one to the other"
        )
    return ReleaseCase(on, off, resonance["state"].copy(), known)


def kinds(period, displacement, known):
    """Flags of damped motions: a period-1 motion is quiet below half the resonance motion."""
    one = np.where(displacement < known[1] / 2, DAMPED_MOTION["quiet"], DAMPED_MOTION["violent"])
    several = np.where(period > 1, DAMPED_MOTION["subharmonic"], one)
    return np.where(period == 0, DAMPED_MOTION["unsettled"], several)


def destination(known, record):
    """Flag of the free motion that a record is of, `known` as in `ReleaseCase`."""
    if not is_settled(record):
        return FREE_MOTION["unresolved"]
    if record["period"] == 3:
        return FREE_MOTION["subharmonic"]
    for name, displacement in zip(("non_resonance", "resonance"), known, strict=True):
        if record["period"] == 1 and abs(record["maximum_displacement"] - displacement) < ALIKE:
            return FREE_MOTION[name]
    return FREE_MOTION["other"]


def _release(here, state, wait, settling, path, entry):
    """Switch the damper off `wait` forcing periods after a strobe, and see where that leads."""
    records = np.zeros(1, MOTION)
    legs.leg(
        here.on,
        here.off,
        state.copy(),
        wait,
        0.0,
        0.0,
        settling.tolerance,
        settling.limit,
        path,
        records,
    )
    entry["phase"], entry["displacement"], entry["velocity"] = wait, path[0, 1], path[0, 2]
    entry["destination"] = destination(here.known, records[0])


def _watch_one(here, draws, lifetime, settling, path, records, entry):
    """A run with the damper on, released once on its way. Returns its life.

    The draws give the phase of switching on, the place of the loose mass, the instant of the
    release, uniform from LEAD strobes on until the run is captured, if it lives so long, and
    the phase of the release in its forcing period.
    """
    legs.leg(
        here.off,
        here.on,
        here.state.copy(),
        draws[0],
        2 * draws[1] - 1,
        0.0,
        settling.tolerance,
        lifetime,
        path,
        records,
    )
    life = lifetime
    if is_settled(records[0]):
        life = legs.life(here.on, path, records[0], settling.tolerance)
    if life > LEAD:
        k = LEAD + int(draws[2] * (life - LEAD))
        rest = np.empty((settling.limit + 2, 5))
        _release(here, path[k + 1, 1:], draws[3], settling, rest, entry)
    return life


def watch(here, seeds, lifetime, settling, workers, progress):
    """Runs from the resonance branch, each released once: lives, records and releases."""
    draws = np.array([np.random.default_rng(seed).random(4) for seed in seeds])
    lives = np.empty(len(draws))
    motions = np.zeros(len(draws), MOTION)
    entries = np.zeros(len(draws), RELEASE)
    for name in ("phase", "displacement", "velocity"):
        entries[name] = np.nan
    entries["destination"] = FREE_MOTION["none"]

    def work(part):
        path = np.empty((lifetime + 2, 5))
        for i in range(part.start, part.stop):
            motion = motions[i : i + 1]
            lives[i] = _watch_one(here, draws[i], lifetime, settling, path, motion, entries[i])

    ensemble.run_chunks(work, len(draws), workers, progress, size=8)
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
    Between contacts the primary moves as it does without the damper, so that all releases within
    one flight are one: a share counts the flights, and the short contacts, that lead somewhere.
    """
    number = len(entries)
    rows = [entries]
    path = np.empty((settling.limit + 2, 5))
    for record in motions:
        rows.append(np.zeros(number, RELEASE))
        for k, entry in enumerate(rows[-1]):
            wait = k * record["period"] / number
            _release(here, record["state"], wait, settling, path, entry)
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
    # Starts only, so the solutions of the elastic damper will do for an inelastic one.
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
    for record in np.concatenate([found, reached]):
        if is_settled(record):
            catalogue.add(record, "random_start")
    return sorted(catalogue.records, key=lambda record: record["maximum_displacement"])
