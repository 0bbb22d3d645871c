"""Migration control: switch the damper on and off until the motion is the small free motion."""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.data.motion_variables import DAMPED_MOTION, FREE_MOTION
from impact_damper.model import bounds
from impact_damper.model.arguments import read_forced
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.settling import check_settling
from impact_damper.motions import ensemble, legs
from impact_damper.motions.attractors import release_set
from impact_damper.motions.following import record_at
from impact_damper.motions.records import NEVER
from impact_damper.motions.traces import states_at
from impact_damper.theory.free_oscillator import main_solutions

# `course` takes SAMPLES samples of Z1 in a cycle. It adds MARGIN cycles before and after a run.
MARGIN, SAMPLES = 10, 40
# Two free motions are equal if their max |Z1| differ by less than this number.
ALIKE = 1e-6
# An entry of a log: the damper is switched on at `on_time` and off at `off_time`. Then the free
# motion, of the kind `destination`, runs until `end_time`. Times: cycles since the run began.
# released_period, released_displacement: period and max |Z1| of the motion before switching off.
SWITCHING = np.dtype(
    [(name, "f8") for name in ("on_time", "off_time", "end_time")]
    + [("released_period", "i2"), ("released_displacement", "f8"), ("destination", "i1")]
)


class ReleaseCase(NamedTuple):
    """Packed parameters with the damper `on` and `off`, and two free motions at one frequency.

    `state` is the state of the resonance motion at the strobe. `known` holds max |Z1| of the
    non-resonance motion, then max |Z1| of the resonance motion.
    """

    on: np.ndarray
    off: np.ndarray
    state: np.ndarray
    known: np.ndarray


@bounds.names_arguments
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

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper or MachineDamper
    frequency : float
        Forcing frequency W, or Hz for a machine, at which two free motions of period 1 exist.
    release : {"settled", "state"}
        With "settled", as in the paper, the damper is switched off at a random phase after the
        motion has settled. With "state" the damper is switched off as soon as switching off leads
        to the small motion.
    seed : int or numpy.random.SeedSequence
        Seed of the random phases of switching and of the random places of the loose mass.
    longest_hold : int
        After this number of forcing cycles with the damper on, it is switched off in any case.
    periods : int
        After this number of forcing cycles in a run the damper is not switched on again.
    switchings : int
        Largest number of switchings. In a switching the damper is switched on, then off.
    settling : Settling, optional
        Settings of the runs. Runs with the damper use only `tolerance`.

    Returns
    -------
    xarray.Dataset
        For each `time` T: the displacement of the primary mass. For each `switching`: the times T
        at which the damper is switched on, the damper is switched off, and the free motion has
        settled; the kinds of motion before and after switching off. For the run: whether it reaches
        the small motion, the number of switchings, the cycles with the damper on, and all cycles.

    Raises
    ------
    ValueError
        If the non-resonance or the resonance motion does not exist at the frequency.

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
        bounds.check_count("seed", seed, **bounds.SEED_RANGE)
    model = read_forced(system, damper, frequency, needs_damper=True)
    bounds.check_count("longest_hold", longest_hold, **bounds.PERIODS_RANGE)
    bounds.check_count("periods", periods, **bounds.PERIODS_RANGE)
    bounds.check_count("switchings", switchings, most=10**4)
    if release not in ("settled", "state"):
        raise ValueError(f"release = {release!r}: must be 'settled' or 'state'")
    case = release_case(model.oscillator, model.damper, model.frequency, settling)
    inside = None
    if release == "state":
        inside = release_set(model.oscillator, model.frequency, settling)
    draws = np.random.default_rng(seed).random((switchings, 3))
    path, log = control(case, draws, longest_hold, settling, periods, inside)
    totals = run_totals(log)
    log = log[: totals["switchings"]]
    times, displacement = course(case, path, log, settling.tolerance)
    data = {"displacement": displacement}
    data |= {name: ("switching", values) for name, values in switching_data(log, case).items()}
    data |= {name: ((), value) for name, value in totals.items()}
    made = model.describe(settling) | {"longest_hold": longest_hold, "periods": periods}
    made |= {"largest_switchings": switchings, "release": release}
    made["seed"] = int(getattr(seed, "entropy", seed))
    made["spawn_key"] = list(getattr(seed, "spawn_key", ()))
    return dataset(data, {"time": times}, made, "Migration control, one run", model)


def _free_motion(oscillator, frequency, start, which, settling):
    p = pack(oscillator, None, start)
    free = main_solutions(oscillator, start)
    angle = free.phase[which] + np.pi / 2
    primary = free.amplitude[which] * np.array([np.cos(angle), -start * np.sin(angle)])
    record = ensemble.settle(p[None], np.tile(primary, (1, 2)), settling, from_strobe=True)[0]
    if record["period"] != 1:
        return None
    return record_at(p, record["state"], 1, FREQUENCY, frequency, settling.tolerance)


def release_case(oscillator, damper, frequency, settling) -> ReleaseCase:
    """Return the `ReleaseCase` of a damper; raise ValueError unless both free motions exist.

    Each free motion is followed towards the fold that ends its branch. With a hardening spring
    the resonance motion is followed upward from a lower frequency, and the non-resonance motion
    downward from a higher frequency. With a softening spring upward and downward are exchanged.
    """
    on, off = pack(oscillator, damper, frequency), pack(oscillator, None, frequency)
    above = min(1.1 * frequency, bounds.FREQUENCY_RANGE["most"])
    below = max(0.9 * frequency, bounds.FREQUENCY_RANGE["least"])
    ends = (above, below) if oscillator.hardening >= 0 else (below, above)
    goal = _free_motion(oscillator, frequency, ends[0], 0, settling)
    resonance = _free_motion(oscillator, frequency, ends[1], -1, settling)
    found = goal, resonance
    known = np.array([np.nan if each is None else each["maximum_displacement"] for each in found])
    if not known[0] + ALIKE < known[1]:
        told = oscillator.scales.told("frequency", frequency, "frequency")
        raise ValueError(
            f"{told}: without the damper there must be both a non-resonance and a resonance "
            "motion, since migration leads from one to the other (a linear spring has only one "
            "motion)"
        )
    return ReleaseCase(on, off, resonance["state"].copy(), known)


def kinds(period, displacement, known):
    """Return each motion's kind, a flag of DAMPED_MOTION. `known`: max |Z1| of free motions."""
    one = np.where(displacement < known[1] / 2, DAMPED_MOTION["quiet"], DAMPED_MOTION["violent"])
    several = np.where(period > 1, DAMPED_MOTION["subharmonic"], one)
    return np.where(period == 0, DAMPED_MOTION["unsettled"], several)


def destination(known, record):
    """Return a free motion's kind, a flag of FREE_MOTION. `known`: max |Z1| of two free motions."""
    if not is_settled(record):
        return FREE_MOTION["unresolved"]
    if record["period"] == 3:
        return FREE_MOTION["subharmonic"]
    for name, displacement in zip(("non_resonance", "resonance"), known, strict=True):
        if record["period"] == 1 and abs(record["maximum_displacement"] - displacement) < ALIKE:
            return FREE_MOTION[name]
    return FREE_MOTION["other"]


def control(case, draws, longest_hold, settling, periods, releases, stop=NEVER):
    """Return the path and the log (`SWITCHING`) of one run of migration control.

    The run begins on the resonance motion. A row of `draws` holds three random numbers from 0 to 1:
    the wait before switching on, in periods of the free motion; the place of the loose mass (0: at
    one wall, 1: at the other); and the wait before switching off, in periods of the motion with the
    damper. If `releases` is None, the last wait begins when the motion has settled, at the latest
    `longest_hold` cycles after the first strobe with the damper. Otherwise `releases` is the
    `ReleaseSet`, the damper is on for at most `longest_hold` cycles, and the last wait is not used.
    After `periods` cycles of the run the damper is not switched on again. The path (m, 5) has a row
    for each strobe and for each switching on or off: forcing cycles since the first strobe, state.
    """
    y, period, strobe, path = case.state.copy(), 1, 0.0, []
    tolerance, limit = settling.tolerance, settling.limit
    none = (np.nan, np.nan, np.nan, 0, np.nan, FREE_MOTION["none"])
    log = np.full(len(draws), np.array(none, SWITCHING))
    for entry, (on_phase, place, off_phase) in zip(log, draws, strict=True):
        wait, place = on_phase * max(period, 1), 2 * place - 1
        if releases is None:
            entry["on_time"] = strobe + wait
            rows, held = legs.leg(
                case.off, case.on, y, wait, place, strobe, tolerance, longest_hold, stop
            )
            entry["released_period"] = held["period"]
            entry["released_displacement"] = held["maximum_displacement"]
            path.append(rows)
            strobe, wait = rows[-1, 0], off_phase * max(int(held["period"]), 1)
            entry["off_time"] = strobe + wait
            rows, free = legs.leg(case.on, case.off, y, wait, 0.0, strobe, tolerance, limit, stop)
        else:
            rows = legs.hold_by_state(
                case.off, case.on, y, wait, place, strobe, tolerance, longest_hold, releases
            )
            path.append(rows[:-1])
            entry["on_time"], released = rows[0, 0], rows[-1, 0]
            entry["off_time"], strobe = released, np.floor(released) + 1.0
            rows, free = legs.run(case.off, y, strobe - released, strobe, tolerance, limit, stop)
        path.append(rows)
        period, strobe = int(free["period"]), rows[-1, 0]
        entry["end_time"] = strobe
        entry["destination"] = destination(case.known, free)
        if entry["destination"] == FREE_MOTION["non_resonance"] or strobe >= periods:
            break
    return np.concatenate(path), log


def course(case, path, log, tolerance):
    """Return times T and Z1 along a run, with MARGIN forcing cycles before and after the run."""
    period = 2 * np.pi / case.on[FREQUENCY]
    path = np.vstack([np.append(-MARGIN, case.state), path])
    ends = np.append(path[1:, 0], path[-1, 0] + MARGIN)
    cycles = np.arange(-MARGIN * SAMPLES, int(ends[-1] * SAMPLES)) / SAMPLES
    times = (cycles + 0.25) * period
    log = log[log["destination"] != FREE_MOTION["none"]]
    switched = np.stack([log["on_time"], log["off_time"]], axis=-1).ravel()
    damped = np.searchsorted(switched, (path[:, 0] + ends) / 2) % 2 == 1
    cuts = np.searchsorted(cycles, np.append(path[:, 0], ends[-1]))
    parts = []
    # Errors grow in a chaotic motion, so the motion is computed anew from each row of the path.
    for row, on, first, last in zip(path, damped, cuts, cuts[1:], strict=False):
        p, begin = case.on if on else case.off, (row[0] + 0.25) * period
        parts.append(states_at(p, row[1:], begin, times[first:last], tolerance))
    return times, np.concatenate(parts)[:, 0]


def switching_data(logs, case):
    """Return dataset variables that describe the switchings in `logs`, as a dict."""
    period = 2 * np.pi / case.on[FREQUENCY]
    kind = kinds(logs["released_period"], logs["released_displacement"], case.known)
    absent = logs["destination"] == FREE_MOTION["none"]
    data = {name: (logs[name] + 0.25) * period for name in ("on_time", "off_time", "end_time")}
    data["released_from"] = np.where(absent, DAMPED_MOTION["none"], kind)
    return data | {"destination": logs["destination"]}


def run_totals(logs):
    """Return a dict of dataset variables with one value for each run, such as its total time."""
    first = logs["on_time"][..., 0]
    reached = np.any(logs["destination"] == FREE_MOTION["non_resonance"], axis=-1)
    yes, no = (flag("trial_outcome", name) for name in ("reached", "not_reached"))
    return {
        "trial_outcome": np.where(reached, yes, no),
        "switchings": np.sum(logs["destination"] != FREE_MOTION["none"], axis=-1),
        "damper_time": np.nansum(logs["off_time"] - logs["on_time"], axis=-1),
        "total_time": np.nanmax(logs["end_time"], axis=-1) - first,
    }
