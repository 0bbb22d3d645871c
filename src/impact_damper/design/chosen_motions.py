"""The largest motion with the chosen gap at each frequency, and its impacts, forces and losses."""

from dataclasses import replace

import numpy as np
import xarray as xr

from impact_damper.data.datasets import flag, from_si, shown_variable, touches_no_wall
from impact_damper.design.cells import Cell
from impact_damper.design.costs import measured_costs, pressure_costs
from impact_damper.design.task import labelled
from impact_damper.model.hertz import HertzContact
from impact_damper.model.packed import FREQUENCY
from impact_damper.model.units import QUANTITIES
from impact_damper.motions import traces
from impact_damper.motions.response import frequency_response
from impact_damper.motions.strobe_map import strobe_time

# SAMPLES: number of states in each forcing cycle among which the largest displacement is found.
# WATCHED: number of cycles over which a motion is measured if it has not settled.
SAMPLES, WATCHED = 64, 200
# STARTS: largest number of random starts at each frequency of the response.
# FURTHER: largest number of cycles that are added to classify a motion that has not settled.
STARTS, FURTHER = 32, 1500
# Variable of the dataset -> (key in the result of `measured_costs`, physical quantity).
COSTS = {
    "impact_rate_by_frequency": ("impact_rate", "rate"),
    "contact_force_by_frequency": ("contact_force", "force"),
    "penetration_by_frequency": ("penetration", "displacement"),
    "impact_speed_by_frequency": ("impact_speed", "velocity"),
    "impact_power_by_frequency": ("impact_power", "power"),
    "acceleration_by_frequency": ("largest_acceleration", "acceleration"),
    "absolute_displacement_by_frequency": ("absolute_displacement", "displacement"),
}


def response_and_costs(task, decision, progress=None) -> xr.Dataset:
    """Return motions with the chosen damper, and impacts and forces of the largest motions."""
    effort = task.effort
    settling = replace(effort.settling, further=FURTHER)
    searched = {"starts": min(STARTS, effort.starts), "seed": effort.seed, "settling": settling}
    searched |= {"workers": effort.workers, "progress": progress}
    damper = task.damper(1e-3 * float(decision["design_gap"]))
    motions = frequency_response(task.machine, damper, task.grid, **searched)
    # Datasets of several steps are merged, so their frequencies must be exactly equal.
    motions = motions.assign_coords(frequency=shown_variable("frequency", task.grid))
    return motions.merge(reached_motions(task, decision, motions))


def reached_motions(task, choice, response) -> xr.Dataset:
    """Return a dataset: displacement, impacts and forces of the largest motion at each frequency.

    Two kinds of motions in `response` count: those to which a random start leads, and those that
    have contacts and to which a placed start leads (see `motions.start_states`).
    """
    sizes = response["maximum_displacement"].values
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
        case = Cell(1e-3 * float(choice["design_gap"]), frequency)
        rows.append(_measured(task, case, sizes[k, column], states[k, column], periods))
    values = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    values["untouched_displacement"] = np.where(untouched > 0, untouched, np.nan)
    return labelled(values, frequency=task.grid)


def _measured(task, case, size, state, periods):
    if not np.isfinite(size):
        return dict.fromkeys(("pressure_by_frequency", *COSTS), np.nan) | {
            "reached_displacement": size,
            "yields_by_frequency": flag("yields_by_frequency", "unknown"),
        }
    p = task.packed(*case)
    begin = strobe_time(p)
    count = periods * SAMPLES
    times = begin + 2 * np.pi / p[FREQUENCY] * np.arange(count + 1) / SAMPLES
    states = traces.states_at(p, state, begin, times, task.effort.settling.tolerance)
    largest = np.abs(task.millimetres(states[:-1, 0])).max()
    costs = measured_costs(p, state.copy(), begin, periods)
    shown = {
        name: task.scales.to_si(costs[cost], quantity) * QUANTITIES[quantity].factor
        for name, (cost, quantity) in COSTS.items()
    }
    contact = task.contact if isinstance(task.contact, HertzContact) else None
    speed = shown["impact_speed_by_frequency"]
    pressure, yields = pressure_costs(task.machine, task.damper(case.gap), contact, speed)
    return shown | {
        "reached_displacement": max(size, largest),
        "pressure_by_frequency": pressure,
        "yields_by_frequency": flag("yields_by_frequency", yields),
    }
