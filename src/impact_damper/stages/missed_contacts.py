"""Contacts that integrators miss near grazing, counted over random passages.

A passage is a free flight whose largest |Z2| is known. With the wall a depth nearer, a contact
begins for certain; with it as much further away, none does. A method that looks at the gap where
its steps end notices the contact if a step ends beyond the wall: SciPy's events and integration
through the kink do so alike. What it does until then does not depend on the wall, so that one run
serves all depths.
"""

import math

import numpy as np

from impact_damper.data.datasets import dataset
from impact_damper.motions.records import first_collisions, trace
from impact_damper.rivals import fixed_step, merson, scipy_methods
from impact_damper.rivals.passages import TOLERANCE, draw_passages, free_flight
from impact_damper.system.bounds import check_count, check_number
from impact_damper.system.checks import check_increasing
from impact_damper.system.packed import CLEARANCE, FREQUENCY
from impact_damper.system.parameters import describe, pack

METHODS = ("taylor", "runge_kutta_4", "merson", *scipy_methods.METHODS)
OUTCOMES = ("found", "unseen", "not_reached", "failed")
MOST_ENDS = 10**5


def _ends(method, p, state, end, resolution):
    """Times and states at the ends of a method's steps in flight over [0, end], the start first.

    None if the run fails, or takes more than `MOST_ENDS` steps.
    """
    first = np.array([[0.0, *state]])
    if method == "runge_kutta_4":
        rows = np.empty((resolution, 5))
        fixed_step.fixed_ends(fixed_step.RUNGE_KUTTA_4, p, state, 0.0, end / resolution, rows)
        if not np.abs(rows[:, 1:]).max() < fixed_step.BEYOND:
            return None
        return np.concatenate([first, rows])
    rows = np.empty((MOST_ENDS, 5))
    start = 1e-3 * end
    _, _, steps, _, _, _ = merson.advance_merson(
        p, state.copy(), 0, 0.0, end, start, resolution, False, rows
    )
    if not 0 <= steps <= MOST_ENDS:
        return None
    return np.concatenate([first, rows[:steps]])


def _own_largest(method, p, passage, end, resolution):
    """A method's |Z2| at the ends of its steps, and at the time of the true extremum, or None."""
    if method in scipy_methods.METHODS:
        states, interpolant, success = scipy_methods.flight_steps(
            method, p, passage.state, 0.0, end, resolution
        )
        return (np.abs(states[:, 2]), abs(interpolant(passage.time)[2])) if success else None
    rows = _ends(method, p, passage.state, end, resolution)
    if rows is None:
        return None
    last = rows[rows[:, 0] <= passage.time][-1]
    part = np.empty((1, 5))
    number = fixed_step.RUNGE_KUTTA_4 if method == "runge_kutta_4" else fixed_step.MERSON
    fixed_step.fixed_ends(number, p, last[1:].copy(), last[0], passage.time - last[0], part)
    return np.abs(rows[:, 3]), abs(part[0, 3])


def _rival_counts(method, p, passages, depths, resolution):
    """Counts (depth, outcome) of the wall touched, (depth,) of it not, error and mean steps."""
    end = 2 * math.pi / p[FREQUENCY]
    touching = np.zeros((len(depths), len(OUTCOMES)), int)
    spurious = np.zeros(len(depths), int)
    steps, errors = 0, []
    for passage in passages:
        run = _own_largest(method, p, passage, end, resolution)
        if run is None:
            touching[:, 3] += 1
            continue
        ends, own = run
        steps += len(ends) - 1
        errors.append(abs(own - passage.extremum))
        seen = ends.max() > passage.extremum - depths
        reached = own > passage.extremum - depths
        touching[:, 0] += seen
        touching[:, 1] += ~seen & reached
        touching[:, 2] += ~seen & ~reached
        spurious += ends.max() > passage.extremum + depths
    if not errors:
        return touching, spurious, np.nan, np.nan
    return touching, spurious, np.median(errors), steps / len(errors)


def _taylor_counts(p, passages, depths, tolerance):
    """The same for the event-driven Taylor series, which is asked for its first contact."""
    states = np.array([passage.state for passage in passages])
    extrema = np.array([passage.extremum for passage in passages])
    own = np.array([_taylor_largest(p, passage, tolerance) for passage in passages])
    failed = ~np.isfinite(own)
    touching = np.zeros((len(depths), len(OUTCOMES)), int)
    spurious = np.zeros(len(depths), int)
    for i, depth in enumerate(depths):
        seen = _taylor_seen(p, states, extrema - depth, tolerance)
        reached = own > extrema - depth
        outcomes = seen, ~seen & reached, ~seen & ~reached
        touching[i] = *(np.sum(each & ~failed) for each in outcomes), failed.sum()
        spurious[i] = np.sum(_taylor_seen(p, states, extrema + depth, tolerance) & ~failed)
    return touching, spurious, np.nanmedian(np.abs(own - extrema))


def _taylor_seen(p, states, clearances, tolerance):
    """Whether each motion comes to a contact within a forcing period."""
    parameters = np.repeat(p[None], len(states), axis=0)
    parameters[:, CLEARANCE] = clearances
    periods = np.empty(len(states))
    first_collisions(parameters, states, 1, tolerance, periods)
    return np.isfinite(periods)


def _taylor_largest(p, passage, tolerance):
    """|Z2| of the Taylor series, in the steps of free flight, at the time of the true extremum."""
    times = np.array([passage.time, 2 * math.pi / p[FREQUENCY]])
    states = np.empty((2, 4))
    trace(free_flight(p), passage.state.copy(), 0.0, times, tolerance, states, np.empty((0, 5)))
    return abs(states[0, 2])


def missed_contacts(
    oscillator,
    frequency,
    *,
    passages,
    radius,
    depths,
    tolerances,
    steps,
    implicit_passages,
    seed=1995,
):
    """Contacts near grazing that each method finds and misses, by depth and tolerance.

    Parameters
    ----------
    oscillator : Oscillator
    frequency : float
        W.
    passages : int
        Random passages for each method and tolerance, the same for all.
    radius : float
        Of the ball from which their states at T = 0 are drawn.
    depths : sequence of float
        Increasing; by how much the wall is nearer than the largest |Z2|, or further away.
    tolerances : sequence of float
        Increasing; relative and absolute, of methods with step control.
    steps : sequence of int
        Increasing, as many as there are tolerances: steps a forcing period of the fixed-step
        method, the fewest in the place of the largest tolerance.
    implicit_passages : int
        The first passages, which the implicit Radau method is run over alone, for it is slow.
    seed : int

    Returns
    -------
    xarray.Dataset
        `passage_count` over (integrator, method_tolerance, depth, contact_outcome): contacts found;
        unseen, where the method's own motion passes the wall between two steps; and not reached,
        where the error of its motion exceeds the depth; and failed, where the run did not come to
        its end. `spurious_count`: contacts reported where there is none. `motion_error`: the
        median of the error of the largest |Z2|; this and `mean_steps` are over the passages that
        did not fail, NaN if all did. `expected_unseen`, for fixed steps, of steps h that
        fall at random on a time beyond the wall of 2 sqrt(2 depth/|Z2''|): the mean of
        max(0, 1 - that time/h).

    Raises
    ------
    TypeError, ValueError
        If an argument is not of its kind or out of range.
    """
    check_count("passages", passages, most=10**6)
    check_count("implicit_passages", implicit_passages, most=passages, why="of the passages")
    check_number("radius", radius, above=0.0, most=1e3)
    depths = check_increasing("depths", [check_number("depth", d, above=0.0) for d in depths])
    tolerances = check_increasing(
        "tolerances", [check_number("tolerance", value, least=1e-13) for value in tolerances]
    )
    steps = [check_count("steps", value, most=MOST_ENDS) for value in steps]
    check_increasing("steps", steps)
    if len(steps) != len(tolerances):
        raise ValueError(f"steps: must be as many as tolerances, {len(tolerances)}; {steps} given")
    p = pack(oscillator, None, frequency)
    drawn_passages, drawn = draw_passages(p, passages, radius, depths[-1], seed)
    free = free_flight(p)
    shape = (len(METHODS), len(tolerances), len(depths))
    counts = np.zeros((*shape, len(OUTCOMES)), int)
    spurious = np.zeros(shape, int)
    mean_steps, error = np.full(shape[:2], np.nan), np.empty(shape[:2])
    totals = np.full(len(METHODS), passages)
    totals[METHODS.index("Radau")] = implicit_passages
    for m, method in enumerate(METHODS):
        for i, tolerance in enumerate(tolerances):
            given = drawn_passages[: totals[m]]
            if method == "taylor":
                found = _taylor_counts(p, given, depths, tolerance)
                counts[m, i], spurious[m, i], error[m, i] = found
            else:
                resolution = steps[-1 - i] if method == "runge_kutta_4" else tolerance
                found = _rival_counts(method, free, given, depths, resolution)
                counts[m, i], spurious[m, i], error[m, i], mean_steps[m, i] = found
    curvatures = np.array([passage.curvature for passage in drawn_passages])
    beyond = 2 * np.sqrt(2 * depths / curvatures[:, None])
    period = 2 * math.pi / p[FREQUENCY]
    expected = [np.maximum(0, 1 - beyond * n / period).mean(axis=0) for n in reversed(steps)]
    data = {
        "passage_count": counts,
        "spurious_count": spurious,
        "mean_steps": mean_steps,
        "motion_error": error,
        "passages": totals,
        "expected_unseen": np.array(expected),
        "fixed_steps": np.array(steps[::-1]),
        "passages_drawn": drawn,
        "extremum_time": np.array([passage.time for passage in drawn_passages]),
        "extremum": np.array([passage.extremum for passage in drawn_passages]),
        "extremum_curvature": curvatures,
    }
    made = describe(oscillator) | {
        "frequency": frequency,
        "passages": passages,
        "implicit_passages": implicit_passages,
        "radius": radius,
        "seed": seed,
        "reference_tolerance": TOLERANCE,
    }
    coordinates = {
        "integrator": list(METHODS),
        "method_tolerance": tolerances,
        "depth": depths,
        "contact_outcome": list(OUTCOMES),
    }
    return dataset(data, coordinates, made, "Contacts missed near grazing")
