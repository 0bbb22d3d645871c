"""Derivatives of the quiet orbit of a design, compared with orbits at slightly changed values."""

from dataclasses import replace

import numpy as np
import pytest
from helpers.design_tasks import task
from helpers.symmetric import CENTRAL, converged, linear_orbit

import impact_damper as idm
from impact_damper.design.quiet_branch import dependence
from impact_damper.design.task import NOMINAL, VARIED
from impact_damper.model.packed import CLEARANCE

# Relative change of a value in a difference quotient.
STEP = 4e-4
# Names of factors of a task that differ from the name of the parameter.
FACTORS = {"linear_stiffness": "stiffness"}


def changed(task, gap, frequency, name, factor):
    """Packed parameters of a task in which the value `name` is multiplied by a factor."""
    if name == "mass":
        return replace(task, mass=factor * task.mass).packed(gap, frequency)
    if name == "frequency":
        return task.packed(gap, factor * frequency)
    factors = np.array(NOMINAL)
    factors[VARIED.index(FACTORS.get(name, name))] = factor
    return task.packed(gap, frequency, tuple(factors))


@pytest.mark.parametrize("excitation", [{"force": 40}, {"unbalance": 0.002}])
def test_changes_in_per_cent_are_those_of_orbits_found_anew(excitation):
    machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.01, **excitation)
    made = task(machine=machine)
    frequency = machine.natural_frequency
    orbit = linear_orbit(*made.system(5e-3, frequency), 0.75)
    gap = 2 * made.scales.to_si(orbit.p[CLEARANCE], "clearance")
    found = dependence(made, orbit)
    parts = (found[name].values for name in ("changed", "displacement_change", "modulus_change"))
    for name, *changes in zip(*parts, strict=True):
        if name in ("cubic_stiffness", "force" if "unbalance" in excitation else "unbalance"):
            assert changes == [0, 0]  # the value is 0
            continue
        name = "force" if name == "unbalance" else name
        logarithms = np.zeros(2)
        for k, weight in CENTRAL.items():
            for sign in (-1, 1):
                p = changed(made, gap, frequency, name, 1 + sign * k * STEP)
                near = converged(p, orbit.state, orbit.phase, True)
                sizes = near.record["maximum_displacement"], abs(near.multipliers[0])
                logarithms += sign * weight * np.log(sizes) / STEP
        assert changes == pytest.approx(logarithms, rel=2e-5, abs=1e-7), name
