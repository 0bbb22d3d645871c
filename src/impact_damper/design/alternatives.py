"""Coarse designs with other values: other loose masses, and a restitution free within a range."""

from dataclasses import replace

import numpy as np
import xarray as xr

from impact_damper.data.datasets import flag
from impact_damper.design.choose import choose, largest_within, least_shares, worst_sizes
from impact_damper.design.compare import coarse_comparison, compare
from impact_damper.design.costs import measured_costs
from impact_damper.design.outcomes import Case, run
from impact_damper.design.screen import gap_span
from impact_damper.design.task import labelled
from impact_damper.motions.strobe_map import strobe_time

# Number of restitutions that are tried, evenly spaced over the range.
RESTITUTIONS = 5
# Masses divided by the nominal mass.
MASSES = (0.5, 0.7, 1.4, 2.0)
# Largest numbers of a reduced design: frequencies, gaps, starts for the choice of the gap, and
# starts at the chosen gap.
FREQUENCIES, GAPS, COARSE_STARTS, STARTS = 5, 20, 8, 24
# Cycles over which the contact force of a motion that is not periodic is measured.
WATCHED = 100


def try_restitutions(task, ends, progress=None) -> xr.Dataset:
    """Return the best gap for each of RESTITUTIONS values between two ends."""
    limit = 1e3 * task.displacement_limit if task.displacement_limit else task.bare.max() / 2
    values, rows = np.linspace(*ends, RESTITUTIONS), []
    for value in values:
        each = replace(task, restitution=float(value), contact=task.contact_stiffness)
        found = coarse_comparison(each, gap_span(each), limit, progress=progress)
        choice = choose(found, task.share, task.gap_tolerance)
        low, high = (choice.gap * (1 + sign * task.gap_tolerance) for sign in (-1, 1))
        gaps = found["candidate_gap"].values
        size = largest_within(gaps, worst_sizes(found), [low], [high])[0]
        rows.append((choice.gap, size, flag("tried_choice", choice.kind)))
    gaps, sizes, kinds = zip(*rows, strict=True)
    made = {"tried_gap": gaps, "tried_displacement": sizes, "tried_choice": kinds}
    return labelled(made, tried_restitution=values)


def best_restitution(tried) -> float:
    """Return the restitution with the best kind of choice and, among these, the least motion."""
    order = np.lexsort((tried["tried_displacement"].values, tried["tried_choice"].values))
    return float(tried["tried_restitution"][order[0]])


def other_masses(task, choice, progress=None) -> xr.Dataset:
    """Return this damper and those of other masses, each with its own gap.

    `choice` is the dataset of `cliff.choose_gap`.
    """
    limit = float(choice["displacement_limit"])
    rows = [(task.mass, *judge(task, float(choice["design_gap"]), limit, progress))]
    for factor in MASSES:
        mass = factor * task.mass
        if mass <= task.machine.mass:
            rows.append((mass, *_reduced_design(task, mass, limit, progress)))
    masses, gaps, sizes, shares, forces = np.array(sorted(rows)).T
    values = {
        "other_gap": gaps,
        "other_displacement": sizes,
        "other_share": shares,
        "other_force": forces,
        "other_best": is_best(masses, np.column_stack([sizes, forces])),
    }
    return labelled(values, other_mass=masses)


def _reduced_design(task, mass, limit, progress):
    """Return the numbers of `judge` for the best gap with another mass."""
    effort = replace(task.effort, frequencies=min(FREQUENCIES, task.effort.frequencies))
    other = replace(
        task,
        mass=mass,
        contact=task.contact_stiffness,
        displacement_limit=1e-3 * limit,
        effort=effort,
    )
    fewer = {"most": GAPS, "starts": COARSE_STARTS}
    coarse = coarse_comparison(other, gap_span(other), limit, **fewer, progress=progress)
    gap = choose(coarse, task.share, task.gap_tolerance).gap
    return judge(other, gap, limit, progress)


def judge(task, gap, limit, progress=None) -> tuple:
    """Return gap, largest displacement, share of quiet starts and force (N) of a damper.

    Displacement (mm) and share are the worst over the band and the tolerated deviation of the gap.
    The force is that of the largest motion at the nominal gap, NaN if a motion escapes.
    """
    gaps = gap * (1 + task.gap_tolerance * np.array([-1, -0.5, 0, 0.5, 1]))
    few = task.few(FREQUENCIES)
    starts = min(STARTS, task.effort.starts)
    found = compare(task, np.unique(gaps), few, limit, starts, "masses", progress)
    cases = [Case(1e-3 * gap, f) for f in few]
    records = run(task, cases, starts, "masses", settling=task.hurried, progress=progress)
    forces = [
        _largest_force(task, case, row[np.argmax(row["maximum_displacement"])])
        for case, row in zip(cases, records, strict=True)
    ]
    return gap, worst_sizes(found).max(), least_shares(found).min(), np.max(forces)


def _largest_force(task, case, record):
    """Return the largest contact force of a motion, N, from its `records.MOTION`."""
    if not np.isfinite(record["maximum_displacement"]):
        return np.nan
    p = task.packed(*case)
    periods = int(record["period"]) or WATCHED
    costs = measured_costs(p, record["state"].copy(), strobe_time(p), periods)
    return float(task.scales.to_si(costs["contact_force"], "force"))


def is_best(masses, costs) -> np.ndarray:
    """Return which dampers are on the Pareto front of small masses and costs, shape (m,) of bool.

    NaN in `costs`, shape (m, k), counts as worse than any number.
    """
    table = np.column_stack([masses, np.where(np.isnan(costs), np.inf, costs)])
    worse = [np.any(np.all(table <= row, axis=1) & np.any(table < row, axis=1)) for row in table]
    return ~np.array(worse)
