"""Gaps and frequencies at which switching the damper off leads to the small free motion."""

import json

import numpy as np
import xarray as xr

from impact_damper.data.datasets import flag
from impact_damper.data.motion_variables import FREE_MOTION
from impact_damper.data.shares import bounding_rank
from impact_damper.design.task import Effort, Task, labelled
from impact_damper.model.bounds import PERIODS_RANGE, check_count, names_arguments
from impact_damper.model.machine import describe_si
from impact_damper.model.units import check_si
from impact_damper.motions.migration import control, release_case
from impact_damper.motions.steady import run_chunks


@names_arguments
def migration(
    machine,
    *,
    mass,
    band,
    restitution,
    contact,
    mount=None,
    gaps=None,
    share=0.95,
    longest_hold=500,
    effort=None,
    progress=None,
):
    """Find gaps and frequencies at which a release of the damper leads to the small free motion.

    During the large free motion the damper is switched on at a random phase, with the loose mass at
    a random place. The damper is switched off (released) at a random phase after the motion has
    settled, or after `longest_hold` cycles. `gaps` are in m. By default they are
    `effort.candidates` gaps in the range that `design_damper` searches. `effort.starts` releases
    are run at each gap and frequency. `progress` is the title of a progress bar. For other
    arguments see `design_damper`.

    A release succeeds if it leads to the small motion. Times (s) begin when the damper is switched
    on, and end when the small motion has settled. Without success they are infinite. The dataset
    has for each gap and frequency the share of releases that succeed, the median time, and a bound,
    `migration_bound`. With 95 % confidence at least the fraction `share` of all releases takes at
    most this time. For each gap the bound is finite at all frequencies from `sure_frequency` to the
    highest frequency with two free motions. `migration_gap` is the gap with the lowest
    `sure_frequency`. ValueError is raised if each frequency has only one free motion.
    """
    effort = Effort() if effort is None else effort
    task = Task(
        machine=machine,
        mass=mass,
        band=band,
        restitution=restitution,
        contact=contact,
        mount=mount,
        tolerances={},
        share=share,
        effort=effort,
    )
    check_count("longest_hold", longest_hold, **PERIODS_RANGE)
    if gaps is None:
        gaps = 1e-3 * np.geomspace(*task.gap_span, effort.candidates)
    gaps = np.array([check_si("gaps", gap, "displacement", above=0) for gap in gaps])
    cases = [_case(task, gaps[0], f) for f in task.grid]
    if not any(cases):
        raise ValueError(
            f"band = {task.band[0]:g} Hz to {task.band[1]:g} Hz: without the damper the machine "
            "has one motion at each frequency, so there is nothing to migrate to"
        )
    places = [(i, j) for i in range(len(gaps)) for j, case in enumerate(cases) if case]
    times = np.full((len(gaps), len(cases), effort.starts), np.nan)
    stop = np.zeros(1, bool)

    def work(part):
        for k in range(part.start, part.stop):
            (i, j), trial = places[k // effort.starts], k % effort.starts
            case = cases[j]._replace(on=task.packed(gaps[i], task.grid[j]))
            seed = effort.seed, i, j, trial
            cycles = release_time(case, seed, longest_hold, effort.settling, stop)
            times[i, j, trial] = cycles / task.grid[j]

    run_chunks(work, len(places) * effort.starts, effort.workers, progress, stop, size=8)
    return _table(task, gaps, times, longest_hold)


def _case(task, gap, frequency):
    oscillator, damper, turning = task.system(gap, frequency)
    try:
        return release_case(oscillator, damper, turning, task.effort.settling)
    except ValueError:
        return None


def release_time(case, seed, longest_hold, settling, stop) -> float:
    """Return the number of cycles from switching the damper on until the small motion has settled.

    `case` is a `ReleaseCase`. The damper stays on for about `longest_hold` cycles at most. The
    result is infinite if another motion is reached, or if the run is ended by stop[0] = True.
    """
    draws = np.random.default_rng(seed).random((1, 3))
    _, log = control(case, draws, longest_hold, settling, 0, None, stop)
    reached = log["destination"][0] == FREE_MOTION["non_resonance"]
    return float(log["end_time"][0] - log["on_time"][0]) if reached else np.inf


def _table(task, gaps, times, longest_hold) -> xr.Dataset:
    rank = bounding_rank(task.share, times.shape[-1])
    bounds = -np.sort(-times, axis=-1)[..., rank - 1]
    one = np.isnan(times[..., 0])
    sure = np.isfinite(bounds)
    last = int(np.flatnonzero(~one.all(axis=0))[-1])
    lowest = np.full(len(gaps), np.nan)
    for i, row in enumerate(sure[:, : last + 1]):
        first = 1 + int(np.max(np.flatnonzero(~row), initial=-1))
        if first <= last:
            lowest[i] = task.grid[first]
    status = np.where(one, "one_motion", np.where(sure, "sure", "not_sure"))
    best = np.nan
    if np.isfinite(lowest).any():
        tied = np.flatnonzero(lowest == np.nanmin(lowest))
        slowest = [np.nanmax(np.where(sure[i], bounds[i], np.nan)) for i in tied]
        best = 1e3 * gaps[tied[int(np.argmin(slowest))]]
    values = {
        "migration_share": np.where(one, np.nan, np.isfinite(times).mean(axis=-1)),
        "migration_time": np.median(times, axis=-1),
        "migration_bound": bounds,
        "migration_status": np.vectorize(lambda name: flag("migration_status", name))(status),
        "sure_frequency": lowest,
        "migration_gap": best,
        "migration_required": task.share,
    }
    found = labelled(values, released_gap=1e3 * gaps, released_frequency=task.grid)
    asked = task.describe() | {"longest_hold": longest_hold}
    return found.assign_attrs(
        title="Migration of a machine to its small motion",
        machine=json.dumps(describe_si(task.machine), sort_keys=True),
        parameters=json.dumps(asked, sort_keys=True),
    )
