"""Methods with equal steps: largest accurate steps in quiet motions, for each stiffness r1."""

import itertools
import math
from dataclasses import replace

import numpy as np

from chatterjee1995.methods.grid_following import Grid
from chatterjee1995.methods.integrators import integrators
from chatterjee1995.methods.quiet_orbits import compliant_orbit
from impact_damper.data.datasets import dataset, is_settled
from impact_damper.data.variables import register
from impact_damper.model.arguments import read_increasing
from impact_damper.model.bounds import STIFFNESS_RANGE
from impact_damper.model.packed import CLEARANCE, FREQUENCY, pack
from impact_damper.model.parameters import describe
from impact_damper.model.settling import Settling
from impact_damper.model.units import UNITLESS
from impact_damper.motions import ensemble
from impact_damper.motions.following import StrobeOrbit
from impact_damper.motions.strobe_map import strobe_time

register(
    """
fixed_method | fixed_method | | | method with equal steps
scaled_step | scaled_step | | h omega_c | step times contact frequency
accuracy | accuracy | | | relative deviation allowed in max |Z1|
stable_step | fixed_method contact_stiffness accuracy | | h | largest step that keeps the accuracy
  together with all smaller ones
step_slope | fixed_method accuracy | | | slope of log(1/h) as a function of log r1, h the largest
  stable step
step_slope_error | fixed_method accuracy | | | standard error of step_slope
linear_limit | fixed_method | | | largest product of step and contact frequency by linear
  stability theory
contact_frequency | contact_stiffness | | omega_c | natural frequency of an undamped contact
    """
)

ACCURACIES = (0.01, 0.1)  # allowed relative error of max |Z1| in each cycle
# An orbit is followed in steps that change r1 by at most a factor FACTOR, and the state by REACH.
FACTOR, REACH = 10.0**0.0625, 0.2
EXACT = 1e-13  # tolerance of the exact orbits, with which runs are compared
CONFIRMED = 4  # `stable_step` is NaN if fewer than this number of the smallest steps are accurate
STIFF = 1e3  # least r1 in the fit of `step_slope`; for larger r1 contacts are short


def orbits_over_stiffness(oscillator, damper, frequency, stiffnesses) -> list:
    """Follow the quiet orbit of `damper` to each stiffness. Return orbits (None: not reached)."""
    p = pack(oscillator, damper, frequency)
    start = np.array([[0.0, 0.0, 0.0, -2 * p[CLEARANCE] * p[FREQUENCY] / math.pi]])
    record = ensemble.settle(p[None], start, Settling(), from_strobe=True)[0]
    if not is_settled(record) or record["period"] != 1 or record["contacts"] != 2:
        raise ArithmeticError(
            f"damper = {damper!r}: has no quiet motion at frequency = {frequency:g}, from which "
            "the stiffness is varied"
        )

    def correct(point, guess):
        each = replace(damper, contact_stiffness=float(point[0]))
        return compliant_orbit(pack(oscillator, each, frequency), guess, REACH, tolerance=EXACT)

    own = damper.contact_stiffness
    stiffer = [value for value in stiffnesses if value >= own]
    softer = [value for value in stiffnesses[::-1] if value < own]
    found = {}
    for targets in (stiffer, softer):
        cells = _in_steps(own, targets)
        grid = Grid(cells[:, None], correct)
        grid.orbits[0,] = StrobeOrbit(record["state"].copy(), complex(np.nan))
        grid.spread()
        found |= {cells[cell]: orbit for cell, orbit in grid.orbits.items() if cell != (0,)}
    return [found.get(value) for value in stiffnesses]


def _in_steps(own, targets):
    cells = [np.array([own])]
    for before, target in itertools.pairwise([own, *targets]):
        count = max(math.ceil(abs(math.log(target / before)) / math.log(FACTOR)), 1)
        cells.append(np.geomspace(before, target, count + 1)[1:])
    return np.concatenate(cells)


def _largest_step(held, tested, steps):
    held, steps = held[tested], steps[tested]
    failing = np.flatnonzero(~held)
    first = failing[-1] + 1 if len(failing) else 0
    return steps[first] if first + CONFIRMED <= len(steps) else np.nan


def _slope(stiffnesses, steps):
    use = np.isfinite(steps) & (stiffnesses >= STIFF)
    if use.sum() < 3:
        return np.nan, np.nan
    line, covariance = np.polyfit(np.log(stiffnesses[use]), -np.log(steps[use]), 1, cov=True)
    return line[0], math.sqrt(covariance[0, 0])


def stable_steps(oscillator, damper, frequency, *, stiffnesses, scaled_steps, most_steps, periods):
    """Return a dataset: the largest steps at which methods with equal steps are accurate.

    `scaled_steps` are the tested steps, multiplied by the natural frequency of a contact. A step is
    not tested if a cycle has more than `most_steps` such steps. A test takes `periods` cycles.
    """
    stiffnesses = read_increasing(UNITLESS, "stiffnesses", stiffnesses, **STIFFNESS_RANGE)
    scaled = read_increasing(UNITLESS, "scaled_steps", scaled_steps, above=0)
    scaled = scaled[::-1]
    orbits = orbits_over_stiffness(oscillator, damper, frequency, stiffnesses)
    contact = np.sqrt(stiffnesses * (1 + 1 / damper.mass_ratio))
    period = 2 * math.pi / frequency
    counts = np.ceil(period * contact[:, None] / scaled).astype(int)
    tested = counts <= most_steps
    methods = integrators("stable_steps").values()
    deviations = np.array([_deviations(each, orbits, counts, tested, periods) for each in methods])
    data = _step_data(deviations, tested, period / counts, stiffnesses) | {
        "linear_limit": [method.stability_limit for method in methods],
        "contact_frequency": contact,
    }
    made = describe(oscillator, damper) | {"frequency": frequency, "periods": periods}
    names = [method.name for method in methods]
    coordinates = {"fixed_method": names, "contact_stiffness": stiffnesses}
    coordinates |= {"scaled_step": scaled, "accuracy": list(ACCURACIES)}
    return dataset(data, coordinates, made, "Largest steps that keep the quiet motion")


def _deviations(method, orbits, counts, tested, periods):
    deviations = np.full(counts.shape, np.nan)
    for i, orbit in enumerate(orbits):
        if orbit is None:
            continue
        given = orbit.parameters, orbit.state, strobe_time(orbit.parameters), periods
        for j in np.flatnonzero(tested[i]):
            largest = method.largest_displacements(*given, counts[i, j])
            away = np.abs(largest / orbit.displacement - 1).max()
            deviations[i, j] = np.inf if np.isnan(away) else away
    return deviations


def _step_data(deviations, tested, sizes, stiffnesses):
    shape = len(deviations), len(stiffnesses), len(ACCURACIES)
    stable = np.empty(shape)
    for m, i, k in np.ndindex(shape):
        stable[m, i, k] = _largest_step(deviations[m, i] <= ACCURACIES[k], tested[i], sizes[i])
    slopes = np.array([[_slope(stiffnesses, row) for row in each.T] for each in stable])
    return {"stable_step": stable, "step_slope": slopes[..., 0], "step_slope_error": slopes[..., 1]}
