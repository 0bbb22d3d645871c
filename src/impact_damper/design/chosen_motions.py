"""Motions with the chosen damper over the band: sizes, peaks, impacts, forces and losses.

A start is an initial state. Random starts are drawn. Placed starts are chosen states: motions at
neighbouring frequencies, and motions of the machine without the damper. A motion is quiet if its
largest displacement is at most the quiet limit.

W T is the phase of the forcing.
"""

import numpy as np
import xarray as xr

from impact_damper.data.datasets import flag, from_si, touches_no_wall
from impact_damper.data.shares import wilson_intervals
from impact_damper.design.costs import measured_costs, pressure_costs
from impact_damper.design.labelled import SIDES, labelled
from impact_damper.design.outcomes import Case, are_quiet
from impact_damper.model.packed import FREQUENCY
from impact_damper.model.units import QUANTITIES
from impact_damper.motions import traces
from impact_damper.motions.strobe_map import strobe_time

# SAMPLES: number of states in a forcing cycle from which a motion is measured.
# WATCHED: number of cycles over which a motion that is not periodic is measured.
SAMPLES, WATCHED = 64, 200
# Variables of the dataset, with the name of the cost (`performance.costs`) and its quantity.
COSTS = {
    "impact_rate_by_frequency": ("impact_rate", "rate"),
    "contact_force_by_frequency": ("contact_force", "force"),
    "penetration_by_frequency": ("penetration", "displacement"),
    "impact_speed_by_frequency": ("impact_speed", "velocity"),
    "impact_loss_by_frequency": ("mean_impact_loss", "energy"),
    "impact_power_by_frequency": ("impact_power", "power"),
    "noise_by_frequency": ("impulse_noise", "impulse_noise"),
}


def reached_motions(task, gap, response, limit, contact) -> xr.Dataset:
    """Return the largest motion to which starts lead at each frequency of the band, with its costs.

    A motion in which the loose mass touches no wall lasts only if the loose mass does not drift at
    all. Such a motion counts as reached only if random starts lead to it. The largest one that does
    not count is stored as `untouched_displacement`.

    Parameters
    ----------
    task : Task
    gap : float
        Gap of the design, mm.
    response : xarray.Dataset
        Result of `frequency_response` with this gap at the frequencies of the task, in SI units.
    limit : float
        Quiet limit, mm.
    contact : HertzContact or None
        Radius and materials from which the pressure in the contact is computed.
    """
    sizes = response["maximum_displacement"].values
    quiet = are_quiet(sizes, response["outcome"].values, limit)
    counts = np.where(quiet, response["motion_starts"].values, 0).sum(axis=1)
    total = response.sizes["start"]
    placed = response["origin"].values == flag("origin", "placed_start")
    alone = touches_no_wall(response)
    by_chance = response["motion_starts"].values > 0
    reached = by_chance | (placed & ~alone)
    untouched = np.where(placed & alone & ~by_chance, sizes, -np.inf).max(axis=1)
    columns = np.argmax(np.where(reached, sizes, -np.inf), axis=1)
    states = from_si(response, task.scales)["state"].values
    rows = []
    for k, (column, frequency) in enumerate(zip(columns, task.grid, strict=True)):
        settled = response["outcome"].values[k, column] == flag("outcome", "settled")
        periods = int(response["period"].values[k, column]) if settled else WATCHED
        case = Case(1e-3 * gap, frequency)
        rows.append(_measured(task, case, sizes[k, column], states[k, column], periods, contact))
    values = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    values |= {
        "reached_quiet_share": counts / total,
        "reached_quiet_interval": wilson_intervals(counts, total),
        "untouched_displacement": np.where(untouched > 0, untouched, np.nan),
    }
    return labelled(values, frequency=task.grid, side=SIDES)


def _measured(task, case, size, state, periods, contact):
    """Return the measured numbers of one motion, keyed by the name of the dataset variable.

    `size` is the largest displacement that earlier runs found (mm), infinite after an escape.
    `state` is a state of the motion at the strobe (W T = pi/2).
    """
    if not np.isfinite(size):
        unknown = ("motion_rms", "motion_peak_mean", "motion_peak_high", "pressure_by_frequency")
        return dict.fromkeys((*unknown, *COSTS), np.nan) | {
            "reached_displacement": size,
            "yields_by_frequency": flag("yields_by_frequency", "unknown"),
        }
    p = task.packed(*case)
    begin = strobe_time(p)
    count = periods * SAMPLES
    times = begin + 2 * np.pi / p[FREQUENCY] * np.arange(count + 1) / SAMPLES
    states = np.empty((count + 1, 4))
    tolerance = task.settling.tolerance
    y = state.copy()
    traces.trace(p, y, begin, times, tolerance, states, np.empty((0, 5)))
    course = task.millimetres(states[:-1, 0])
    peaks = np.abs(course).reshape(periods, SAMPLES).max(axis=1)
    costs = measured_costs(p, state.copy(), begin, periods)
    shown = {
        name: task.scales.to_si(costs[cost], quantity) * QUANTITIES[quantity].factor
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
