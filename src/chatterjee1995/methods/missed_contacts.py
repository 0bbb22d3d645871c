"""Contacts near grazing that integrators miss, counted in random passages.

A passage is a flight without contact whose largest |Z2| is known, where Z2 is the displacement of
the primary mass relative to the loose mass. If the wall is placed nearer than this |Z2| by some
depth, a contact begins. If it is placed farther away by the same depth, none does. Integrators
other than the Taylor series of this package find the contact only if a step ends beyond the wall.
This holds whether they locate the beginning of a contact, as SciPy does, or not. Their steps before
the contact do not depend on the wall. One run without walls therefore gives the outcome for all
depths.
"""

import math

import numpy as np

from chatterjee1995.methods.methods import COMPARED, METHODS, integrators
from chatterjee1995.methods.passages import TOLERANCE, draw_passages, without_walls
from chatterjee1995.methods.runs import check_resolutions
from impact_damper.data.datasets import dataset
from impact_damper.model.bounds import RADIUS_RANGE, RUNS_RANGE, check_count, check_number
from impact_damper.model.checks import check_increasing, check_numbers
from impact_damper.model.packed import CLEARANCE, FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.motions.ensemble import collide
from impact_damper.motions.traces import trace

LABELS = COMPARED["missed_contacts"]
# The docstring of `missed_contacts` explains the outcomes.
OUTCOMES = ("found", "unseen", "not_reached", "failed")


def _counts(integrator, p, passages, depths, resolution):
    """Return the numbers of contacts that an integrator finds and misses, at each depth.

    Returns
    -------
    touching : array of int, shape (depth, outcome)
        Number of passages with each of OUTCOMES if the wall is nearer by the depth.
    spurious : array of int, shape (depth,)
        Number of contacts reported if the wall is farther away by the depth.
    error, steps : float
        Median error of the largest |Z2|, and mean number of steps; NaN if all runs failed.
    """
    end = 2 * math.pi / p[FREQUENCY]
    touching = np.zeros((len(depths), len(OUTCOMES)), int)
    spurious = np.zeros(len(depths), int)
    steps, errors = 0, []
    for passage in passages:
        run = integrator.flight(p, passage.state, end, resolution, passage.time)
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
    """Return `touching`, `spurious` and `error` of `_counts` for the event-driven Taylor series.

    The series is run again for the wall at each depth, until its first contact.
    """
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
    """Return whether each motion has a contact within a forcing cycle."""
    parameters = np.repeat(p[None], len(states), axis=0)
    parameters[:, CLEARANCE] = clearances
    return np.isfinite(collide(parameters, states, 1, tolerance))


def _taylor_largest(p, passage, tolerance):
    """Return |Z2| by the Taylor series without walls, at the time of the passage's largest |Z2|."""
    times = np.array([passage.time, 2 * math.pi / p[FREQUENCY]])
    states = np.empty((2, 4))
    trace(without_walls(p), passage.state.copy(), 0.0, times, tolerance, states, np.empty((0, 5)))
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
    """Return the numbers of contacts near grazing that integrators find and miss.

    Parameters
    ----------
    oscillator : Oscillator
    frequency : float
        W.
    passages : int
        Number of random passages for each integrator and tolerance, the same for all.
    radius : float
        Radius of the ball from which the states of the passages at T = 0 are drawn.
    depths : sequence of float
        Increasing distances by which the wall is nearer than the largest |Z2|, or farther away.
    tolerances : sequence of float
        Increasing relative and absolute tolerances of methods with step control.
    steps : sequence of int
        Increasing numbers of steps per forcing cycle for fixed-step methods, as many as there are
        tolerances; the fewest steps take the place of the largest tolerance.
    implicit_passages : int
        Implicit methods, which are slow, run only this number of the passages, the first ones.
    seed : int

    Returns
    -------
    xarray.Dataset
        `passage_count` for each (integrator, method_tolerance, depth, contact_outcome). Outcomes:
        found; unseen (the computed motion passes the wall and returns within one step); not reached
        (the computed motion does not reach the wall, since its error exceeds the depth); failed
        (the run did not reach its end). `spurious_count`: contacts reported where none exists.
        `motion_error`, the median error of the largest |Z2|, and `mean_steps` come from the
        passages that did not fail; NaN if all failed. `expected_unseen`: the share expected to be
        unseen if fixed steps h end at random times. This is the mean of max(0, 1 - b/h), with the
        time b = 2 sqrt(2 depth/|Z2''|) that the motion spends beyond the wall.

    Raises
    ------
    TypeError, ValueError
        If an argument is not of its kind or out of range.
    """
    check_count("passages", passages, **RUNS_RANGE)
    check_count("implicit_passages", implicit_passages, most=passages, why="of the passages")
    check_number("radius", radius, **RADIUS_RANGE)
    depths = check_increasing("depths", check_numbers("depths", depths, above=0.0))
    tolerances, steps = check_resolutions(tolerances, steps)
    p = pack(oscillator, None, frequency)
    drawn_passages, drawn = draw_passages(p, passages, radius, depths[-1], seed)
    totals = [implicit_passages if METHODS[name].implicit else passages for name in LABELS]
    data = _count_table(p, drawn_passages, totals, depths, tolerances, steps)
    data |= _passage_table(drawn_passages, depths, steps, 2 * math.pi / p[FREQUENCY])
    data |= {
        "passages": np.array(totals),
        "fixed_steps": np.array(steps),
        "passages_drawn": drawn,
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
        "integrator": list(LABELS),
        "method_tolerance": tolerances,
        "depth": depths,
        "contact_outcome": list(OUTCOMES),
    }
    return dataset(data, coordinates, made, "Contacts missed near grazing")


def _count_table(p, passages, totals, depths, tolerances, steps):
    """Return the counts and errors of each integrator at each tolerance or number of steps.

    `totals` holds for each integrator the number of passages that it runs, the first ones.
    """
    free, methods, found = without_walls(p), integrators(), []
    for name, total in zip(LABELS, totals, strict=True):
        for resolution in steps if METHODS[name].fixed else tolerances:
            given = passages[:total], depths, resolution
            if name == "taylor":
                found.append((*_taylor_counts(p, *given), np.nan))
            else:
                found.append(_counts(methods[name], free, *given))
    names = ("passage_count", "spurious_count", "motion_error", "mean_steps")
    shape = len(LABELS), len(tolerances)
    return {
        name: np.reshape(each, (*shape, *np.shape(each[0])))
        for name, each in zip(names, zip(*found, strict=True), strict=True)
    }


def _passage_table(passages, depths, steps, period):
    """Return time, value and curvature of each largest |Z2|, and shares expected to be unseen."""
    curvatures = np.array([passage.curvature for passage in passages])
    beyond = 2 * np.sqrt(2 * depths / curvatures[:, None])
    expected = [np.maximum(0, 1 - beyond * n / period).mean(axis=0) for n in steps]
    return {
        "expected_unseen": np.array(expected),
        "extremum_time": np.array([passage.time for passage in passages]),
        "extremum": np.array([passage.extremum for passage in passages]),
        "extremum_curvature": curvatures,
    }
