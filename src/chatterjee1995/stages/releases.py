"""Runs of migration control, and releases of the damper (section 5 of the paper)."""

from dataclasses import replace
from itertools import count

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled
from impact_damper.data.motion_variables import DAMPED_MOTION, FREE_MOTION
from impact_damper.data.shares import BOUNDS, wilson
from impact_damper.data.variables import VARIABLES, register
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.motions import ensemble, legs
from impact_damper.motions.migration import (
    SWITCHING,
    control,
    course,
    destination,
    kinds,
    release_case,
    run_totals,
    switching_data,
)
from impact_damper.motions.records import MOTION, NEVER
from impact_damper.motions.response import frequency_response
from impact_damper.motions.simulate import random_states
from impact_damper.motions.start_states import describe_search
from impact_damper.motions.steady import run_chunks
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.motions.sweep import Catalogue
from impact_damper.motions.traces import states_at
from impact_damper.theory.single_harmonic import impacting_solutions

register(
    """
example | | | | index of the run whose displacement is stored
bound | bound | | | share, or lower or upper end of its 95 % interval
damped_motion | damped_motion | | | kind of damped motion
free_motion | free_motion | | | kind of free motion
destination_count | damped_motion free_motion | | | releases by damped and free motion
reached_share | bound | | | share of runs that arrive on the non-resonance branch
within_share | bound | | | share of runs that arrive within 350 cycles
damped_kind | damped | | | kind of damped motion
  : released_from
damped_period | damped | | n | period in cycles, 0 if it has not settled
damped_displacement | damped | displacement | max |Z1| | largest displacement, if settled
damped_contacts | damped | | | contacts begun per cycle, if the motion has settled
release_phase | damped release | | | cycles from Omega T = pi/2 to the release
release_displacement | damped release | displacement | Z1 | displacement of the primary mass at
  the release
release_velocity | damped release | velocity | Z1' | velocity of the primary mass at the release
release_destination | damped release | | | free motion to which the release leads
  : destination
release_share | damped free_motion bound | | | share of releases that lead to each free motion
    """
)

LEAD = 20  # number of cycles before the first release; then the start of a run matters no longer
PAPER_CYCLES = 350  # cycles within which the paper's controller reaches the non-resonance branch
CAPTURE = 0.1  # a run is near an orbit if Z1 and Z1' differ from the orbit by at most this number
# A release: cycles since a strobe (W T = pi/2), Z1 and Z1', and the free motion that it leads to.
RELEASE = np.dtype(
    [("phase", "f8"), ("displacement", "f8"), ("velocity", "f8"), ("destination", "i1")]
)
KINDS = list(DAMPED_MOTION)[1:]
DESTINATIONS = list(FREE_MOTION)[1:]


def migration(
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
    settling,
    workers=1,
    progress=None,
):
    """Return a dataset of `trials` runs of migration control, and of releases of the damper.

    A run ends at the goal, after `periods` cycles, or after `switchings` releases. The damper is
    switched off at a random phase after the motion has settled, or after `longest_hold` cycles.
    `releases` releases take place from each settled motion with the damper. In addition, each of
    `releases` runs has one release, in its transient and within the first `lifetime` cycles.
    """
    case = release_case(oscillator, damper, frequency, settling)
    roots = np.random.SeedSequence(seed).spawn(2)
    generators = map(np.random.default_rng, roots[0].spawn(trials))
    draws = np.array([each.random((switchings, 3)) for each in generators])
    logs, stop = np.zeros(draws.shape[:2], SWITCHING), np.zeros(1, bool)

    def work(part):
        for i in range(part.start, part.stop):
            _, logs[i] = control(case, draws[i], longest_hold, settling, periods, None, stop)

    run_chunks(work, trials, workers, progress, stop, size=8)
    totals = run_totals(logs)
    data = switching_data(logs[:, : np.max(totals["switchings"])], case)
    example = _example(totals)
    path, log = control(case, draws[example], longest_hold, settling, periods, None)
    times, displacement = course(case, path, log, settling.tolerance)
    data |= totals | _summary(data, totals) | {"example": example, "displacement": displacement}
    motions, entries = watch_runs(
        case, roots[1].spawn(releases), lifetime, settling, workers, progress
    )
    known = _settled_motions(oscillator, damper, frequency, seed, settling, workers, motions)
    data |= release_data(case, known, entries, settling)
    coordinates = {"time": times, "bound": BOUNDS}
    coordinates |= {"damped_motion": KINDS, "free_motion": DESTINATIONS}
    made = describe(oscillator, damper, settling) | {"frequency": frequency}
    made |= {"longest_hold": longest_hold, "periods": periods, "largest_switchings": switchings}
    made |= {"trials": trials, "releases": releases, "lifetime": lifetime, "seed": seed}
    return dataset(data, coordinates, made, "Migration control")


def _example(totals):
    reached = totals["trial_outcome"] == flag("trial_outcome", "reached")
    if not reached.any():
        return 0
    middle = np.quantile(totals["switchings"][reached], 0.5, method="lower")
    return int(np.argmax(reached & (totals["switchings"] == middle)))


def _summary(switchings, totals):
    reached = totals["trial_outcome"] == flag("trial_outcome", "reached")
    within = reached & (totals["total_time"] <= PAPER_CYCLES)
    before, after = switchings["released_from"], switchings["destination"]
    return {
        "destination_count": [
            [np.sum((before == DAMPED_MOTION[k]) & (after == FREE_MOTION[d])) for d in DESTINATIONS]
            for k in KINDS
        ],
        "reached_share": wilson(np.sum(reached), len(reached)),
        "within_share": wilson(np.sum(within), len(reached)),
    }


def _release(case, state, wait, settling, stop=NEVER):
    tolerance, limit = settling.tolerance, settling.limit
    path, record = legs.leg(case.on, case.off, state.copy(), wait, 0.0, 0.0, tolerance, limit, stop)
    return wait, *path[0, 1:3], destination(case.known, record)


def watch_runs(case, seeds, lifetime, settling, workers, progress):
    """Switch the damper on in the resonance motion; return the runs, and a release from each run.

    The release takes place at a random time after LEAD cycles, while the run is transient. A run
    that settles is transient until it is near its orbit (CAPTURE) and stays there. Any other run is
    transient for `lifetime` cycles. If the transient is too short, the release is NaN.
    """
    draws = np.array([np.random.default_rng(seed).random(4) for seed in seeds])
    motions = np.zeros(len(draws), MOTION)
    entries = np.full(len(draws), np.array((np.nan,) * 3 + (FREE_MOTION["none"],), RELEASE))
    stop = np.zeros(1, bool)

    def work(part):
        for i in range(part.start, part.stop):
            phase, place, instant, wait = draws[i]
            path, motions[i] = legs.leg(
                *(case.off, case.on, case.state.copy(), phase, 2 * place - 1, 0.0),
                *(settling.tolerance, lifetime, stop),
            )
            captured = is_settled(motions[i])
            life = _life(case.on, path, motions[i], settling.tolerance) if captured else lifetime
            if life > LEAD:
                state = path[LEAD + int(instant * (life - LEAD)) + 1, 1:]
                entries[i] = _release(case, state, wait, settling, stop)

    run_chunks(work, len(draws), workers, progress, stop, size=8)
    return motions, entries


def _life(p, path, record, tolerance):
    begin, period = strobe_time(p), 2 * np.pi / p[FREQUENCY]
    strobes = begin + np.arange(record["period"]) * period
    orbit = states_at(p, record["state"], begin, strobes, tolerance)
    last = record["periods_run"]
    there = orbit[np.arange(-last, 1) % len(orbit), :2]
    far = np.any(np.abs(path[1:, 1:3] - there) > CAPTURE, axis=1)
    return int(np.max(np.flatnonzero(far), initial=-1)) + 1


def release_data(case, motions, entries, settling):
    """Return a dict of the variables on releases. The first axis is the motion with the damper.

    Index 0 stands for all motions that have not settled, and `entries` are their releases. The
    other indices stand for `motions`, whose releases are equally spaced over each period.
    """
    number = len(entries)
    rows = [entries]
    for record in motions:
        waits = np.arange(number) * record["period"] / number
        releases = [_release(case, record["state"], wait, settling) for wait in waits]
        rows.append(np.array(releases, RELEASE))
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


def _settled_motions(oscillator, damper, frequency, seed, settling, workers, known):
    on = pack(oscillator, damper, frequency)
    # The solutions of (7) for elastic contact are good starts for an inelastic damper too.
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


def release_scan(
    oscillator,
    damper,
    frequencies,
    *,
    starts=24,
    radius=None,
    releases=100,
    lifetime=200,
    seed=1995,
    settling,
    workers=1,
    progress=None,
):
    """Return a dataset of the free motions to which releases lead, at each of `frequencies`.

    `starts` random starts lead to settled motions. Each of these has `releases` releases.
    In addition, each of `releases` runs has one release, in its transient (<= `lifetime` cycles).
    """
    cases = [release_case(oscillator, damper, frequency, settling) for frequency in frequencies]
    search = {"starts": starts, "radius": radius, "seed": seed, "settling": settling}
    response = frequency_response(
        oscillator, damper, frequencies, **search, workers=workers, progress=progress
    )
    seeds = np.random.SeedSequence(seed).spawn(len(cases))
    rows = []
    for i, case in enumerate(cases):
        _, entries = watch_runs(case, seeds[i].spawn(releases), lifetime, settling, workers, None)
        motions = _scan_records(response.isel(frequency=i))
        rows.append(release_data(case, motions, entries, settling))
    width = max(len(row["damped_kind"]) for row in rows)
    names = [f"damped_{each}" for each in ("kind", "period", "displacement", "contacts")]
    names.append("release_share")
    data = {name: np.array([_padded(row[name], width) for row in rows]) for name in names}
    data = {name: (("frequency", *VARIABLES[name].dims), values) for name, values in data.items()}
    made = describe(oscillator, damper, settling) | describe_search(starts, radius, seed)
    made |= {"releases": releases, "lifetime": lifetime}
    coordinates = {"frequency": response["frequency"].values}
    coordinates |= {"free_motion": DESTINATIONS, "bound": BOUNDS}
    return dataset(data, coordinates, made, "Free motions to which releases of the damper lead")


def _scan_records(response):
    keep = response["outcome"].values == flag("outcome", "settled")
    found = np.zeros(np.sum(keep), MOTION)
    for name in ("period", "maximum_displacement", "contacts", "state"):
        found[name] = response[name].values[keep]
    return found[::-1]


def _padded(values, length):
    missing = np.nan if values.dtype.kind == "f" else -1
    widths = [(0, length - len(values))] + [(0, 0)] * (values.ndim - 1)
    return np.pad(values, widths, constant_values=missing)
