"""Numbers of contacts near grazing that each integrator finds and misses."""

import math

import numpy as np

from chatterjee1995.methods.integrators import integrators
from chatterjee1995.methods.passages import TOLERANCE, draw_passages, without_walls
from impact_damper.data.datasets import dataset
from impact_damper.data.variables import register
from impact_damper.model.arguments import read_increasing
from impact_damper.model.bounds import METHOD_TOLERANCE_RANGE
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.model.units import UNITLESS

register(
    """
integrator | integrator | | | method of integration
method_tolerance | method_tolerance | | | tolerance of the method
depth | depth | | | distance by which a passage would go beyond the wall if it were not there
contact_outcome | contact_outcome | | | result of a method at a contact
passage_count | integrator method_tolerance depth contact_outcome | | | number of contacts that a
  method finds, misses between two steps, or does not reach because its motion is inaccurate, and
  number of failed runs
contacts_missed | integrator method_tolerance depth | | | share of completed runs in which the
  contact is not found
spurious_count | integrator method_tolerance depth | | | number of contacts that a method reports
  in passages without contact
motion_error | integrator method_tolerance | | | median error of the largest |Z2| of a passage,
  failed runs excluded
fixed_steps | method_tolerance | | | steps per cycle of the fixed-step method
expected_unseen | method_tolerance depth | | | expected share of contacts at random times that
  begin and end within one fixed step
    """
)

# `unseen`: the computed motion passes the wall and returns within one step. `not_reached`: the
# computed motion is inaccurate and does not pass the wall. `failed`: the run breaks off.
OUTCOMES = ("found", "unseen", "not_reached", "failed")


def missed_contacts(
    oscillator, frequency, *, passages, radius, depths, tolerances, steps, seed=1995
):
    """Return a dataset with the numbers of contacts near grazing that integrators find and miss.

    `passages` motions begin at random states in a ball of the given `radius`. For each of `depths`
    the wall is placed twice: so that the loose mass enters the wall by this depth, and so that it
    turns back at the same distance before the wall. Integrators with equal steps use no
    tolerance. `steps` are their numbers of steps in a cycle.
    """
    depths = read_increasing(UNITLESS, "depths", depths, above=0.0)
    tolerances = read_increasing(UNITLESS, "tolerances", tolerances, **METHOD_TOLERANCE_RANGE)
    steps = steps[::-1]  # the fewest steps are stored at the largest tolerance
    if len(steps) != len(tolerances):
        raise ValueError(f"steps = {steps}: must be as many as tolerances, {len(tolerances)}")
    p = pack(oscillator, None, frequency)
    drawn = draw_passages(p, passages, radius, depths[-1], seed)
    data = _count_table(without_walls(p), drawn, depths, tolerances, steps)
    data |= {
        "expected_unseen": _expected(drawn, depths, steps, 2 * math.pi / p[FREQUENCY]),
        "fixed_steps": steps,
    }
    made = describe(oscillator) | {"frequency": frequency, "passages": passages, "radius": radius}
    made |= {"seed": seed, "reference_tolerance": TOLERANCE}
    names = list(integrators("missed_contacts"))
    coordinates = {"integrator": names, "method_tolerance": tolerances, "depth": depths}
    coordinates["contact_outcome"] = list(OUTCOMES)
    return dataset(data, coordinates, made, "Contacts missed near grazing")


def counts(integrator, p, passages, depths, resolution):
    """Return two arrays with counts, and the median error of max |Z2|.

    The first array counts contacts. It has a row for each depth and a column for each of OUTCOMES.
    The second has a number for each depth: how many contacts are reported that do not exist.
    """
    end = 2 * math.pi / p[FREQUENCY]
    touching = np.zeros((len(depths), len(OUTCOMES)), int)
    spurious = np.zeros(len(depths), int)
    errors = []
    for passage in passages:
        run = integrator.flight(p, passage.state, end, resolution, passage.time)
        if run is None:
            touching[:, 3] += 1
            continue
        ends, own = run
        errors.append(abs(own - passage.extremum))
        levels = passage.extremum + np.concatenate([-depths, depths])
        seen = integrator.touches(p, passage.state, levels, resolution)
        seen, false = np.split(ends.max() > levels if seen is None else seen, 2)
        reached = own > passage.extremum - depths
        touching[:, 0] += seen
        touching[:, 1] += ~seen & reached
        touching[:, 2] += ~seen & ~reached
        spurious += false
    return touching, spurious, np.median(errors) if errors else np.nan


def _count_table(p, passages, depths, tolerances, steps):
    methods = integrators("missed_contacts").values()
    found = [
        counts(method, p, passages, depths, resolution)
        for method in methods
        for resolution in (steps if method.fixed else tolerances)
    ]
    names = ("passage_count", "spurious_count", "motion_error")
    shape = len(methods), len(tolerances)
    table = {
        name: np.reshape(each, (*shape, *np.shape(each[0])))
        for name, each in zip(names, zip(*found, strict=True), strict=True)
    }
    ended = len(passages) - table["passage_count"][..., 3]
    share = 1 - table["passage_count"][..., 0] / np.where(ended > 0, ended, np.nan)
    return table | {"contacts_missed": share}


def _expected(passages, depths, steps, period):
    # A contact lasts b = 2 sqrt(2 depth/|Z2''|). It lies in one step h with chance max(0, 1 - b/h).
    curvatures = np.array([passage.curvature for passage in passages])
    beyond = 2 * np.sqrt(2 * depths / curvatures[:, None])
    return np.array([np.maximum(0, 1 - beyond * n / period).mean(axis=0) for n in steps])
