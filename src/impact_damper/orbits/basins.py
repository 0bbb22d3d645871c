"""Basins of attraction in a plane of states, and the robustness of attractors against shocks.

Without a damper the boundaries of basins are curves of states: the stable manifolds of unstable
orbits. From a state on the stable manifold of an orbit the motion tends to this orbit. The curves
are computed backwards in time, because errors then decrease. `window` and `reach` are pairs of
bounds on the moduli of Z1 and Z1'. A curve is stored within `window` and followed within `reach`.
The names *convergence time*, *finite-time basin stability* and *minimal critical shock* come from
Attractors.jl, version 2 (StabilityQuantifiersAccumulator).
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from scipy.ndimage import binary_dilation

from impact_damper.data.datasets import dataset, flag
from impact_damper.data.sweeps import runs_of_true
from impact_damper.data.variables import BASIN_LABEL
from impact_damper.kernel.batch import advance
from impact_damper.model import bounds
from impact_damper.model.arguments import read_forced, read_pair, read_span
from impact_damper.model.packed import DAMPING, FREQUENCY
from impact_damper.model.settling import check_settling
from impact_damper.motions.attractors import (
    REACH,
    find_attractors,
    free_attractors,
    label_damped,
    orbit_states,
    with_neighbourhoods,
)
from impact_damper.motions.ensemble import label_states
from impact_damper.motions.start_states import free_motions
from impact_damper.motions.strobe_map import STROBE
from impact_damper.orbits.shooting import find_orbit

# By default the plane of states reaches to WIDTH x the largest |Z1| and |Z1'| of free motions.
WIDTH = 1.5
# Newton's method searches for unstable orbits from each state of a grid of NEWTON x NEWTON states.
NEWTON = 16
# If n states reach no known attractor, every k-th of these states is used to search for further
# attractors, where k is the larger of n // TRIED and 1.
TRIED = 64
# Default positions Z2/d0 of the loose mass. Each state (Z1, Z1') is run once for each position.
PLACES = (-0.8, -0.4, 0.0, 0.4, 0.8)
CELLS_RANGE = {"least": 2, "most": 10**4}


class Labelled(NamedTuple):
    """Labels of the n states (Z1, Z1') of a plane. Each state is run with m states (Z2, Z2').

    labels: Index of the attractor to which a run leads, or a negative flag if none, shape (m, n).
    periods: Number of forcing cycles after which the label is known, shape (m, n).
    records: Record of each attractor (`records.MOTION`).
    label: Function that takes k states, shape (k, 4), and returns their labels and periods.
    """

    labels: np.ndarray
    periods: np.ndarray
    records: np.ndarray
    label: Callable


@bounds.names_arguments
def basins(
    system,
    damper,
    frequency,
    *,
    displacement=None,
    velocity=None,
    cells=400,
    phase=STROBE,
    loose=None,
    shock=None,
    within=300,
    settling=None,
    workers=1,
    progress=None,
):
    """Find the attractor (stable periodic motion) to which each state of a plane leads.

    Without a damper a motion is run until it enters a neighbourhood in which all motions provably
    tend to a stable orbit. With a damper it is run until it has settled.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
    frequency : float
        Forcing frequency W, or Hz for a machine.
    displacement, velocity : float or (float, float), optional
        Range of Z1 and of Z1', for a machine in m and m/s. A number is the half width of a range
        around 0, a pair is the least and the greatest value. The default half widths are 1.5 times
        the largest displacement and the largest speed of the motions without a damper.
    cells : int
        Number of states on each axis.
    phase : float
        Phase W T of the forcing at which the motions begin, radian.
    loose : sequence of float, optional
        Z2 and Z2' of all states (for a machine in m and m/s), only with a damper. By default each
        state is run five times, with the loose mass at relative rest at five places in the gap. The
        result then also holds, for each state and attractor, the share of places that lead to it.
    shock : float, optional
        Impulse on the primary mass: in N s for a machine, otherwise a dimensionless jump of Z1'. If
        a shock is given, the result includes the time in which motions return to an attractor.
    within : int
        Time limit of the finite-time basin stability, in forcing cycles.
    settling : Settling, optional
        How long motions are run, and how accurately. The default is `Settling()`.
    workers : int
        Number of threads. The result does not depend on this number.
    progress : str, optional
        Title of a progress bar.

    Returns
    -------
    xarray.Dataset
        For each state of the grid: the index of the attractor, or a negative flag that says why
        there is no attractor; and the convergence time in forcing cycles, -1 without an attractor.
        For each attractor: the period, the largest displacement, Z1 and Z1' at `phase`, and

        - the share of states that lead to the attractor, and their median convergence time;
        - with `shock`: the longest convergence time after an impulse of +shock or -shock on a state
          of the attractor at `phase`. It is infinite if a motion does not return;
        - the finite-time basin stability: the share of states from which motions reach the
          attractor in `within` cycles;
        - the minimal critical shock: the smallest impulse at `phase` after which the motion does
          not return, or infinity. The largest impulse tried changes Z1' by the largest speed in the
          plane.

        Without a damper also: unstable orbits with the period of an attractor, and the boundaries
        of basins. A boundary is the stable manifold of an unstable orbit.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> found = idm.basins(idm.Oscillator(0.215), None, 1.85, cells=40)
    >>> found.attrs["title"]
    'Basins of attraction'
    """
    settling = check_settling(settling)
    model = read_forced(system, damper, frequency)
    p = model.pack()
    bounds.check_count("cells", cells, **CELLS_RANGE)
    phase = bounds.check_number("phase", phase, least=0, most=2 * math.pi)
    bounds.check_count("within", within, most=10**8)
    if shock is not None:
        shock = model.scales.read("shock", shock, "impulse", above=0, most=bounds.FASTEST)
    free = free_motions(model.oscillator, model.frequency, settling)
    sizes = np.array([free.displacement or 1.0, free.speed or 1.0])
    sides = _sides(model.scales, sizes, displacement, velocity)
    window = np.max(np.abs(sides), axis=1)
    grid = [np.linspace(*ends, cells) for ends in sides]
    plane = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    running = {"workers": workers, "progress": progress}
    made = model.describe(settling) | {"cells": cells, "within": within, "shock": shock}
    if damper is None:
        if loose is not None:
            raise ValueError(f"loose = {bounds.shown(loose)}: must be None without a damper")
        reach = np.maximum(REACH * sizes, 1.5 * window)
        data, found = _free(p, plane, window, reach, phase, cells, settling, running)
    else:
        places = None if loose is None else read_pair(model.scales, "loose", loose)
        data, found = _damped(p, plane, model.damper, phase, cells, places, settling, running)
        made |= {"loose": None if places is None else places.tolist()}
    data |= _attractor_data(p, found, phase)
    data |= robustness(p, found, phase, window[1], shock, within)
    times = np.where(found.labels >= 0, found.periods, -1).max(axis=0)
    data["basin_time"] = times.reshape(cells, cells)
    coordinates = {
        "basin_displacement": grid[0],
        "basin_velocity": grid[1],
        "basin_phase": ((), phase),
        "frequency": ((), p[FREQUENCY]),
    }
    return dataset(data, coordinates, made, "Basins of attraction", model)


def _sides(scales, sizes, displacement, velocity):
    sides = np.outer(WIDTH * sizes, (-1.0, 1.0))
    given = ("displacement", displacement, bounds.FARTHEST), ("velocity", velocity, bounds.FASTEST)
    for row, (name, value, most) in zip(sides, given, strict=True):
        if isinstance(value, list | tuple | np.ndarray):
            row[:] = read_span(scales, name, value, name, least=-most, most=most)
        elif value is not None:
            row[:] = scales.read(name, value, name, above=0, most=most) * np.array([-1, 1])
    return sides


def _free(p, plane, window, reach, phase, cells, settling, running):
    attractors = free_attractors(p, reach / 2, settling)
    limits = settling.tolerance, settling.limit
    labels, periods = label_states(p, plane, phase, attractors, *limits, **running)
    lost = np.flatnonzero(labels == BASIN_LABEL["unresolved"])
    if len(lost):
        more = find_attractors(p, plane[lost[:: max(1, len(lost) // TRIED)]], settling)
        first = more.centre[np.unique(more.owner, return_index=True)[1]]
        known = np.isclose(first[:, None], attractors.centre, atol=1e-6).all(axis=2).any(axis=1)
        both = np.concatenate([attractors.records, more.records[~known]])
        attractors = with_neighbourhoods(p, both)
        again = label_states(p, plane[lost], phase, attractors, *limits, **running)
        labels[lost], periods[lost] = again
        order = np.argsort(attractors.records["maximum_displacement"], kind="stable")
        rank = np.argsort(order)
        labels = np.where(labels >= 0, rank[np.maximum(labels, 0)] if len(rank) else labels, labels)
        attractors = with_neighbourhoods(p, attractors.records[order])
    data = boundary_data(p, attractors, window, reach, phase, cells, settling)
    data["basin_label"] = labels.reshape(cells, cells).astype(np.int8)

    def label(states):
        return label_states(p, states[:, :2], phase, attractors, *limits, running["workers"])

    return data, Labelled(labels[None], periods[None], attractors.records, label)


def boundary_data(p, attractors, window, reach, phase, cells, settling):
    """Return the dataset variables that describe unstable orbits and boundaries of basins."""
    # Unstable orbits lie closer together near the origin, so the grid of guesses is finer there.
    even = np.linspace(-1, 1, NEWTON)
    grid = [half * even * np.abs(even) for half in reach / 2]
    states = np.stack(np.meshgrid(*grid), axis=-1).reshape(-1, 2)
    found = saddles(p, states, attractors.records["period"].tolist(), phase)
    points, owner, cut = [], [], []
    gap = np.full((1, 2), np.nan)
    spacing = 2 * window / (cells - 1)
    for index, orbit in enumerate(found):
        pieces, complete = stable_manifold(orbit, settling.tolerance, window, spacing, reach)
        cut.append(flag("saddle_curve", "complete" if complete else "cut"))
        for piece in pieces:
            points += [piece, gap]
            owner += [index] * (len(piece) + 1)
    curve = np.concatenate(points or [np.empty((0, 2))])
    return {
        "saddle_period": np.array([orbit.periods for orbit in found], int),
        "saddle_displacement": np.array([orbit.state[0] for orbit in found]),
        "saddle_velocity": np.array([orbit.state[1] for orbit in found]),
        "saddle_curve": np.array(cut, int),
        "boundary_displacement": curve[:, 0],
        "boundary_velocity": curve[:, 1],
        "boundary_saddle": np.array(owner, int),
    }


def _damped(p, plane, damper, phase, cells, loose, settling, running):
    if loose is None:
        places = [(place * damper.clearance, 0.0) for place in PLACES]
    else:
        places = [tuple(loose)]
    planes = [np.hstack([plane, np.tile(place, (len(plane), 1))]) for place in places]
    states = np.concatenate(planes)
    labels, periods, records = label_damped(p, states, phase, settling, **running)
    labels, periods = (each.reshape(len(places), -1) for each in (labels, periods))
    same = np.all(labels == labels[0], axis=0)
    share = [np.mean(labels == index, axis=0) for index in range(len(records))]
    shown = np.where(same, labels[0], BASIN_LABEL["mixed"])
    data = {"basin_label": shown.reshape(cells, cells).astype(np.int8)}
    if len(places) > 1:
        data["basin_share"] = np.array(share).reshape(len(records), cells, cells)

    def label(states):
        return label_damped(p, states, phase, settling, records, running["workers"])[:2]

    return data, Labelled(labels, periods, records, label)


def _attractor_data(p, found, phase):
    records = found.records
    shares = [np.mean(found.labels == index) for index in range(len(records))]
    points = np.full((len(records), max(records["period"], default=1), 2), np.nan)
    for row, record in zip(points, records, strict=True):
        row[: record["period"]] = orbit_states(p, record, phase)[:, :2]
    return {
        "attractor": np.arange(len(records)),
        "attractor_period": records["period"],
        "attractor_displacement": records["maximum_displacement"],
        "attractor_share": shares,
        "attractor_point": points[..., 0],
        "attractor_speed": points[..., 1],
    }


# Distance from a saddle (an unstable orbit) to the first computed state of its stable manifold.
NEAR = 1e-5
# A stable manifold is computed on each side of its saddle from FIRST_POINTS states. They are
# followed backwards in time over at most MOST_PERIODS forcing cycles. In each cycle, new states are
# inserted at most MOST_HALVINGS times between neighbouring states that are too far apart. A side is
# cut short when more than MOST_POINTS states are stored, or more than MOST_IN_ALL are computed.
MOST_PERIODS, MOST_POINTS, MOST_IN_ALL, MOST_HALVINGS = 60, 40_000, 100_000, 12
FIRST_POINTS = 33
# Neighbouring states of a manifold differ in Z1 and Z1' by at most one cell. Outside the plane they
# may differ by OUTSIDE x `reach`, the largest |Z1| and |Z1'| to which the manifold is followed.
OUTSIDE = 0.01
# Two orbits are the same if their states differ by less than SAME.
SAME = 1e-6
# Number of states that one call of compiled code integrates. Ctrl-C waits for the end of a call.
CHUNK = 4096


def saddles(p, states, periods, phase):
    """Return the unstable orbits of given `periods` that Newton's method finds from `states`."""
    orbits, known = [], np.empty((0, 2))
    for n in sorted(set(periods)):
        for state in states:
            orbit = find_orbit(p, np.tile(state, 2), n, phase)
            if not orbit.converged or not abs(orbit.multipliers[0]) > 1:
                continue
            if len(known) and np.min(np.max(np.abs(known - orbit.state[:2]), axis=1)) < SAME:
                continue
            turns = orbit.phase + 2 * math.pi * np.arange(n)
            known = np.concatenate([known, [orbit.at(turn)[:2] for turn in turns]])
            orbits.append(orbit)
    return orbits


def run_backwards(p, states, phase, tolerance, reach):
    """Return the states one forcing cycle before `states`. A state beyond `reach` gives NaN."""
    reverse = p.copy()
    reverse[DAMPING] = -p[DAMPING]
    begin, period = -phase / p[FREQUENCY], 2 * math.pi / p[FREQUENCY]
    earlier = np.full_like(states, np.nan)
    inside = np.flatnonzero(np.all(np.abs(states) <= reach, axis=1))
    for first in range(0, len(inside), CHUNK):
        part = inside[first : first + CHUNK]
        y = np.tile(states[part] * (1, -1), 2)
        sides, contacts = np.zeros(len(part), np.int64), np.zeros(len(part), np.int64)
        starts = np.full(len(part), begin)
        rows = np.tile(reverse, (len(part), 1))
        advance(rows, y, sides, starts, starts + period, tolerance, contacts)
        earlier[part] = y[:, :2] * (1, -1)
    return earlier


def stable_manifold(orbit, tolerance, window, spacing, reach):
    """Return the curves of a saddle's stable manifold, and whether none of them was cut short."""
    values, vectors = np.linalg.eig(orbit.monodromy[:2, :2])
    k = int(np.argmin(np.abs(values)))
    direction = vectors[:, k].real / np.linalg.norm(vectors[:, k].real)
    # If the multiplier is negative, a motion changes its side of the saddle in each period.
    growth = 1 / abs(values[k].real) ** (1 if values[k].real > 0 else 2)
    given = growth, tolerance, window, spacing, reach
    sides = [_grow(orbit, side * direction, *given) for side in (-1, 1)]
    return [piece for pieces, _ in sides for piece in pieces], all(whole for _, whole in sides)


def _grow(orbit, direction, growth, tolerance, window, spacing, reach):
    def earlier(states):
        return run_backwards(orbit.p, states, orbit.phase, tolerance, reach)

    places = np.linspace(0, 1, FIRST_POINTS)
    later = orbit.state[:2] + NEAR * growth ** places[:, None] * direction
    pieces, total, within = [], 0, 0
    for _ in range(MOST_PERIODS):
        states = earlier(later)
        for _ in range(MOST_HALVINGS):
            wide = _wide(states, window, spacing, reach)
            if not wide.any() or len(states) > MOST_IN_ALL:
                break
            middle = 0.5 * (later[:-1] + later[1:])[wide]
            at = np.flatnonzero(wide) + 1
            later = np.insert(later, at, middle, axis=0)
            states = np.insert(states, at, earlier(middle), axis=0)
        inside = np.all(np.abs(states) <= window + spacing, axis=1)
        near = np.all(np.abs(states) <= reach, axis=1)
        if not near.any():
            return pieces, True
        total, within = total + np.sum(near), within + np.sum(inside)
        if total > MOST_IN_ALL or within > MOST_POINTS:
            break
        for first, last in runs_of_true(inside):
            pieces.append(states[max(first - 1, 0) : last + 1])
        later = states[binary_dilation(near)]
    return pieces, False


def _wide(states, window, spacing, reach):
    apart = np.abs(np.diff(states, axis=0))
    inside = np.all(np.abs(states) <= window + 2 * spacing, axis=1)
    near = np.all(np.abs(states) <= reach, axis=1)
    inside, near = inside[1:] | inside[:-1], near[1:] | near[:-1]
    lost = np.isnan(apart).any(axis=1)
    allowed = np.where(inside[:, None], spacing, OUTSIDE * reach)
    return np.where(lost, inside, near & np.any(apart > allowed, axis=1))


# The minimal critical shock is found in four rounds. Round k divides a range of shocks into
# SHOCKS[k] parts. The next range is the first part whose largest shock drives a motion away.
SHOCKS = (256, 64, 64, 64)


def robustness(p, found, phase, widest, shock, within) -> dict:
    """Return dataset variables that hold a number for each attractor. `found` is a `Labelled`.

    attractor_time: Median convergence time of the states of the plane that lead to the attractor.
    attractor_within: Share of all states of the plane that lead to it within `within` cycles.
    attractor_shock: Smallest jump of Z1', at most `widest`, that drives a motion away from it.
    attractor_return: Longest convergence time after a jump of Z1' by -`shock` or `shock`.
    """
    rows = []
    for index, record in enumerate(found.records):
        own, states, returned = found.labels == index, orbit_states(p, record, phase), np.nan
        if shock is not None:
            leaves, periods = _after(found, index, states, np.array([-shock, shock]))
            returned = np.inf if leaves.any() else periods.max()
        critical = min(_critical(found, index, states, most) for most in (-widest, widest))
        share = np.mean(own & (found.periods <= within))
        middle = np.median(found.periods[own]) if own.any() else np.nan
        rows.append((middle, share, critical, returned))
    names = ("attractor_time", "attractor_within", "attractor_shock", "attractor_return")
    return dict(zip(names, np.reshape(rows, (-1, 4)).T, strict=True))


def _after(found, index, states, shocks):
    pushed = np.repeat(states, len(shocks), axis=0)
    pushed[:, 1::2] += np.tile(shocks, len(states))[:, None]
    labels, periods = (each.reshape(len(states), -1) for each in found.label(pushed))
    return np.any(labels != index, axis=0), np.max(periods, axis=0)


def _critical(found, index, states, most):
    low, high = 0.0, most
    for parts in SHOCKS:
        shocks = np.linspace(low, high, parts + 1)
        leaves, _ = _after(found, index, states, shocks[1:])
        if not leaves.any():
            return np.inf
        k = int(np.argmax(leaves))
        low, high = shocks[k], shocks[k + 1]
    return abs(high)
