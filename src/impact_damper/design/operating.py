"""The operating range of a design: maps of quiet starts and of the quiet orbit's stability."""

import numpy as np
import xarray as xr

from impact_damper.design.absorbers import SHARES
from impact_damper.design.outcomes import Case, are_quiet, run
from impact_damper.design.quiet_branch import quiet_orbit
from impact_damper.design.task import SIDES, VARIED, labelled
from impact_damper.model.bounds import RESTITUTION_RANGE
from impact_damper.orbits.grid_following import Grid, follow_line
from impact_damper.orbits.orbit import STROBE
from impact_damper.orbits.quiet_orbits import PHASE, dominant_root, find_quiet_orbit
from impact_damper.orbits.shooting import shoot

# CELLS: largest number of cells along each axis of a map; fewer for a task with few candidates.
# CELL_STARTS: starts in a cell.
CELLS, CELL_STARTS = 11, 12
# Ends of the map over gap and restitution: gaps divided by the nominal gap, and least restitution.
GAPS, LEAST_RESTITUTION = (0.5, 1.6), 0.3
# Shortest step between cells divided by their distance, and bisections of an end of stability.
SHORTEST, BISECTIONS = 2.0**-10, 12


def operating_maps(task, choice, progress=None) -> xr.Dataset:
    """Return the maps over frequency and force, and over gap and restitution.

    `choice` is the dataset of `cliff.choose_gap`.
    """
    names = ("design_gap", "branch_frequency", "displacement_limit")
    gap, frequency, limit = (float(choice[name]) for name in names)
    given = (task, gap, frequency, quiet_orbit(task, gap, frequency), limit, progress)
    return force_map(*given).merge(damper_map(*given))


def force_map(task, gap, frequency, orbit, limit, progress=None) -> xr.Dataset:
    """Return the map over frequency and force; `orbit` is the quiet one at `frequency`, or None.

    Forces are multiples of the nominal one, and the quiet limit is proportional to them.
    """
    frequencies, shares = task.few(CELLS, frequency), np.array(SHARES)
    cases = [[_case(gap, f, "force", share) for share in shares] for f in frequencies]
    share, worst = _starts(task, cases, limit * shares[None], "force_map", progress)
    start = Case(1e-3 * gap, frequency)
    near = int(np.argmin(np.abs(frequencies - frequency))), int(np.argmin(np.abs(shares - 1)))
    grid = quiet_grid(task, cases, near, start, orbit)
    ends = [_stable_forces(task, grid, row, gap, f) for row, f in enumerate(frequencies)]
    values = {
        "force_map_share": share,
        "force_map_displacement": worst,
        "force_map_modulus": _moduli(grid),
        "stability_force_by_frequency": np.array(ends),
    }
    return labelled(values, operating_frequency=frequencies, force_share=shares, side=SIDES)


def damper_map(task, gap, frequency, orbit, limit, progress=None) -> xr.Dataset:
    """Return the map over gap (mm) and restitution at a frequency (Hz)."""
    count = min(CELLS, task.effort.candidates + 3)
    gaps = gap * np.geomspace(*GAPS, count)
    restitutions = np.linspace(LEAST_RESTITUTION, RESTITUTION_RANGE["most"], count)
    cases = [
        [_case(each, frequency, "restitution", e / task.restitution) for e in restitutions]
        for each in gaps
    ]
    share, worst = _starts(task, cases, limit, "damper_map", progress)
    near = tuple(
        int(np.argmin(np.abs(values - value)))
        for values, value in ((gaps, gap), (restitutions, task.restitution))
    )
    grid = quiet_grid(task, cases, near, Case(1e-3 * gap, frequency), orbit)
    values = {
        "damper_map_share": share,
        "damper_map_displacement": worst,
        "damper_map_modulus": _moduli(grid),
    }
    return labelled(values, map_gap=gaps, map_restitution=restitutions)


def quiet_grid(task, cases, near, start, orbit) -> Grid:
    """Return the quiet orbits of a map, followed from `orbit` of the case `start`.

    The first cell reached is `near`. Without an orbit the grid is empty.
    """
    parameters = np.array([[task.packed(*case) for case in row] for row in cases])
    grid = Grid(parameters, find_quiet_orbit, shortest=SHORTEST, extrapolating=True)
    if orbit is None:
        return grid
    p = task.packed(*start)
    first, _ = find_quiet_orbit(p, shoot(p, orbit.state, 1, STROBE)[0].at(PHASE))
    if first is not None:
        followed = follow_line(find_quiet_orbit, p, parameters[near], first, shortest=SHORTEST)
        if followed.arrived:
            grid.put(near, followed.orbit)
            grid.spread()
    return grid


def _case(gap, frequency, name, factor):
    """Return the case of a gap (mm) in which the value called `name` has a factor."""
    return Case(1e-3 * gap, frequency, tuple(factor if k == name else 1.0 for k in VARIED))


def _starts(task, cases, limits, stream, progress):
    """Return the shares of quiet starts and the largest displacements (mm) of a map."""
    shape = len(cases), len(cases[0])
    running = {"settling": task.hurried, "progress": progress}
    records = run(task, [case for row in cases for case in row], CELL_STARTS, stream, **running)
    sizes = task.millimetres(records["maximum_displacement"])
    limits = np.broadcast_to(limits, shape).reshape(-1, 1)
    quiet = are_quiet(sizes, records["outcome"], limits).mean(axis=1)
    return quiet.reshape(shape), sizes.max(axis=1).reshape(shape)


def _moduli(grid):
    """Return the modulus of the largest multiplier of the orbit in each cell, NaN without one."""
    moduli = np.full(grid.shape, np.nan)
    for cell, orbit in grid.orbits.items():
        moduli[cell] = abs(dominant_root(orbit))
    return moduli


def _stable_forces(task, grid, row, gap, frequency):
    """Return the multiples of the force around 1 between which the orbit of a row is stable.

    An end beyond the map is the end of the map. Both are NaN if the orbit is unstable or unknown at
    the nominal force.
    """
    stable = _moduli(grid)[row] < 1
    nominal = int(np.argmin(np.abs(np.array(SHARES) - 1)))
    if not stable[nominal]:
        return np.nan, np.nan
    ends = []
    for step in (-1, 1):
        last = nominal
        while 0 <= last + step < len(stable) and stable[last + step]:
            last += step
        inside, orbit = SHARES[last], grid.orbits[row, last]
        if 0 <= last + step < len(stable):
            outside = SHARES[last + step]
            for _ in range(BISECTIONS):
                middle = np.sqrt(inside * outside)
                p = task.packed(*_case(gap, frequency, "force", middle))
                found = follow_line(find_quiet_orbit, orbit.p, p, orbit, shortest=SHORTEST)
                if found.arrived and abs(dominant_root(found.orbit)) < 1:
                    inside, orbit = middle, found.orbit
                else:
                    outside = middle
        ends.append(inside)
    return tuple(ends)
