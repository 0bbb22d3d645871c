"""Dampers as they are built keep their promises in a simulator without code of the library."""

import numpy as np
import pytest
from helpers.design_tasks import needs_compiler, task
from references.built import BOARD, by_program
from scipy.stats import binom

import impact_damper as idm
from impact_damper.design.promise import Promise
from impact_damper.design.task import NOMINAL
from impact_damper.motions.start_states import random_starts

PUMP = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.01, force=40)
VERTICAL = {"inclination": "90 deg", "friction_coefficient": 0.2, "normal_force": 2}
BUILT = {
    "vertical": (PUMP, VERTICAL, 4e-3),
    "inclined": (PUMP, {"inclination": "30 deg", "friction_coefficient": 0.05}, 4e-3),
    "on a base": (BOARD, {}, 3e-3),
}
# Number of new starts of each design; forcing cycles of a run; first cycles of a run that are not
# measured, in which most chaotic transients end.
NEW, CYCLES, LEAD = 120, 700, 600


@needs_compiler
@pytest.mark.parametrize("name", BUILT)
def test_both_programs_compute_the_same_motion(name):
    machine, mount, _ = BUILT[name]
    damper = machine.damper(
        mass=0.6, gap="8 mm", restitution=0.6, contact_stiffness=1e6, mount=mount
    )
    state = (1e-3, 0.1, 1e-3, 0.3)
    found = idm.simulate(machine, damper, 20.5, state, start=0.0, periods=4, samples=4000)
    expected = by_program(machine, damper, 20.5, state, 4, 0, 4000)
    assert float(np.abs(found.displacement).max()) == pytest.approx(1e3 * expected, rel=1e-6)
    assert found.sizes["contact"] > 2


@pytest.mark.thorough
@needs_compiler
@pytest.mark.parametrize("name", BUILT)
def test_new_starts_keep_the_promise(name):
    """The starts are run at the frequency and the gap's deviation with the largest displacement."""
    machine, mount, gap = BUILT[name]
    damper = {"mass": 1.2, "restitution": 0.6, "contact": 1e6, "mount": mount}
    made = task(machine=machine, **damper, band=(20.3, 20.7), frequencies=3, starts=59)
    sets = np.ones((2, len(NOMINAL)))
    sets[1, 0] = 0.95
    promise = Promise(made, gap, sets, ("confirmed", 0))
    k, worst = promise.worst
    states, _ = random_starts(*made.system(gap, worst, sets[k]), NEW, 33, made.effort.settling)
    states *= [made.scales.to_si(1.0, kind) for kind in ("displacement", "velocity")] * 2
    damper = made.damper(gap, tuple(sets[k]))
    runs = [1e3 * by_program(machine, damper, worst, each, CYCLES, LEAD) for each in states]
    assert promise.size < 0.5 * made.bare.max()
    assert sum(size > promise.size for size in runs) <= binom.ppf(0.999, NEW, 0.05)
    assert max(runs) > 0.5 * promise.size
