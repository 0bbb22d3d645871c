"""Largest stable steps: exact orbits compared with 80-bit arithmetic, and slopes."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER
from numpy.testing import assert_allclose
from references import extended

from chatterjee1995.methods import stable_steps as steps
from impact_damper.model.parameters import Damper


@pytest.mark.skipif(bool(extended.obstacle()), reason=extended.obstacle() or "runs")
@pytest.mark.parametrize("damper", [DESIGN, INELASTIC], ids=["elastic", "inelastic"])
def test_orbits_return_in_80_bit_arithmetic(damper):
    found = steps.orbits_over_stiffness(PAPER, damper, 2.0, [100.0, 2000.0, 1e5])
    for orbit in found:
        begin = 0.25 * math.pi
        run = extended.run(orbit.parameters, orbit.state, begin, [begin + math.pi])
        assert run.begun == 2
        assert_allclose(run.states[-1].astype(float), orbit.state, atol=1e-8)
        assert abs(orbit.multiplier) < 1


def test_largest_step_needs_all_smaller_ones():
    sizes = np.arange(9.0, 0.0, -1.0)
    held = np.array([1, 0, 1, 0, 1, 1, 1, 1, 1], bool)
    tested = np.ones(9, bool)
    assert steps._largest_step(held, tested, sizes) == 5
    tested[-2:] = False
    assert np.isnan(steps._largest_step(held, tested, sizes))
    held[-1] = False
    assert np.isnan(steps._largest_step(held, np.ones(9, bool), sizes))


def test_an_accuracy_that_few_of_the_steps_keep_has_no_largest_step():
    damper = Damper(0.25, 1.0, 0.75)
    given = dict(stiffnesses=[100.0, 1000.0], scaled_steps=np.geomspace(0.02, 4, 9), periods=5)
    data = steps.stable_steps(PAPER, damper, 2.0, most_steps=5000, **given)
    tight, loose = data.stable_step.sel(fixed_method="runge_kutta_4", contact_stiffness=100.0)
    assert np.isnan(tight) and 0 < loose <= math.pi


def test_no_quiet_motion_is_told():
    with pytest.raises(ArithmeticError, match="has no quiet motion"):
        steps.orbits_over_stiffness(PAPER, Damper(0.12, 0.3), 1.0, [1000.0])
