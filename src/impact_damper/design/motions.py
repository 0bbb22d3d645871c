"""The motions of a chosen damper over the band: sizes, peaks, impacts, forces and losses."""

import numpy as np
import xarray as xr

from impact_damper.data.datasets import flag, is_settled
from impact_damper.design.costs import measured_costs, pressure_costs
from impact_damper.design.labelled import SIDES, labelled
from impact_damper.design.outcomes import Case, interval
from impact_damper.design.outcomes import run as run_starts
from impact_damper.machine.units import QUANTITIES
from impact_damper.motions import records as motion_records
from impact_damper.motions.strobe_map import strobe_time
from impact_damper.system.packed import FREQUENCY

# Samples in a forcing period, and periods over which a motion that is not periodic is measured.
SAMPLES, WATCHED = 64, 200
# Variables over the frequency, and the costs that they hold.
COSTS = {
    "impact_rate_by_frequency": ("impact_rate", "rate"),
    "contact_force_by_frequency": ("contact_force", "force"),
    "penetration_by_frequency": ("penetration", "displacement"),
    "impact_speed_by_frequency": ("impact_speed", "velocity"),
    "impact_loss_by_frequency": ("mean_impact_loss", "energy"),
    "impact_power_by_frequency": ("impact_power", "power"),
    "noise_by_frequency": ("impulse_noise", "impulse_noise"),
}


def reached_motions(task, gap, limit, contact, **running) -> xr.Dataset:
    """Return, for each frequency of the band, the largest motion that starts reach, and its costs.

    Random starts and placed starts are run, with the full settling of the task.

    Parameters
    ----------
    task : Task
    gap, limit : float
        Gap of the design, and largest displacement of a quiet motion, mm.
    contact : HertzContact or None
    running
        `workers` and `progress` of `outcomes.run`.
    """
    cases = [Case(1e-3 * gap, f) for f in task.grid]
    found = run_starts(task, cases, task.starts, task.seed + 90, placed=True, **running)
    sizes = task.millimetres(found.random["maximum_displacement"])
    counts = (sizes <= limit).sum(axis=1)
    rows = []
    for case, random, placed in zip(cases, found.random, found.placed, strict=True):
        every = np.concatenate([random, placed])
        worst = every[np.argmax(every["maximum_displacement"])]
        rows.append(_measured(task, case, worst, contact))
    values = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    values |= {
        "reached_quiet_share": counts / task.starts,
        "reached_quiet_interval": interval(counts, task.starts),
    }
    return labelled(values, frequency=task.grid, side=SIDES)


def _measured(task, case, record, contact):
    """Return the measurements of one motion, keyed by registered name."""
    size = task.millimetres(record["maximum_displacement"])
    if not np.isfinite(size):
        unknown = ("motion_rms", "motion_peak_mean", "motion_peak_high", "pressure_by_frequency")
        return dict.fromkeys((*unknown, *COSTS), np.nan) | {
            "reached_displacement": size,
            "yields_by_frequency": flag("yields_by_frequency", "unknown"),
        }
    p = task.packed(*case)
    periods = int(record["period"]) if is_settled(record) else WATCHED
    begin = strobe_time(p)
    count = periods * SAMPLES
    times = begin + 2 * np.pi / p[FREQUENCY] * np.arange(count + 1) / SAMPLES
    states = np.empty((count + 1, 4))
    tolerance = task.settling.tolerance
    y = record["state"].copy()
    motion_records.trace(p, y, begin, times, tolerance, states, np.empty((0, 5)))
    course = task.millimetres(states[:-1, 0])
    peaks = np.abs(course).reshape(periods, SAMPLES).max(axis=1)
    costs = measured_costs(p, record["state"].copy(), begin, periods)
    shown = {
        name: task.scales.to_si(costs[cost], quantity) * QUANTITIES[quantity].share
        for name, (cost, quantity) in COSTS.items()
    }
    speed = shown["impact_speed_by_frequency"]
    pressed = pressure_costs(task.machine, task.damper(case.gap), contact, speed)
    return shown | {
        "reached_displacement": max(size, peaks.max()),
        "motion_rms": np.sqrt(np.mean(course**2)),
        "motion_peak_mean": peaks.mean(),
        "motion_peak_high": np.quantile(peaks, 0.95),
        "pressure_by_frequency": pressed["contact_pressure"],
        "yields_by_frequency": pressed["contact_yields"],
    }
