"""Symmetric orbits found by the speed of the loose mass, and where they lose stability."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from chatterjee1995.comparisons.masri_caughey import two_impact_motions
from chatterjee1995.comparisons.masri_caughey_stability import Boundary, stability_boundaries
from chatterjee1995.comparisons.symmetric_orbits import (
    boundary_near,
    orbit_at_clearance,
    orbit_with_speed,
)
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.simulate import simulate

LINEAR = Oscillator(0.02, 1.0, cubic=0.0)


def test_both_searches_find_the_same_orbit():
    damper = Damper(0.05, 20.0, 0.4, 1e6)
    (motion,) = [each for each in two_impact_motions(LINEAR, damper, 1.0) if each.stable]
    one = orbit_at_clearance(LINEAR, damper, 1.0, motion)
    same = orbit_with_speed(LINEAR, damper, 1.0, one.ratio)
    assert_allclose(same.clearance, damper.clearance, rtol=1e-8)
    assert_allclose(same.displacement, one.displacement, rtol=1e-8)
    assert_allclose(same.modulus, one.modulus, rtol=1e-7)


def test_orbit_repeats_in_a_simulation():
    """After half a period the simulated state is the mirror image, after a period the same."""
    found = orbit_with_speed(LINEAR, Damper(0.05, 1.0, 0.4, 1e5), 1.0, 0.6)
    motion = simulate(
        LINEAR,
        Damper(0.05, found.clearance, 0.4, 1e5),
        1.0,
        found.orbit.state,
        periods=1,
        samples=2,
        start=found.orbit.phase,
    )
    names = ("displacement", "velocity", "relative_displacement", "relative_velocity")
    states = np.array([motion[name].values for name in names]).T
    assert_allclose(states[2], states[0], atol=1e-8 * found.clearance)
    assert_allclose(states[1], -states[0], atol=1e-8 * found.clearance)
    assert motion.sizes["contact"] == 2


@pytest.mark.parametrize("frequency", [0.95, 1.0])
def test_boundaries_are_where_multipliers_pass_the_unit_circle(frequency):
    damper = Damper(0.05, 1.0, 0.4, 1e6)
    for boundary in stability_boundaries(LINEAR, damper, frequency):
        found = boundary_near(LINEAR, damper, frequency, boundary)
        # A fold is found as a maximum of the clearance, which determines s to half the digits only.
        assert_allclose(found.modulus, 1, atol=1e-5 if boundary.event == "fold" else 1e-9)
        assert_allclose(found.clearance, boundary.motion.clearance, rtol=1e-3)


def test_where_stability_does_not_change_there_is_no_boundary():
    damper = Damper(0.05, 20.0, 0.4, 1e6)
    (motion,) = [each for each in two_impact_motions(LINEAR, damper, 1.0) if each.stable]
    with pytest.raises(ArithmeticError, match="no neimark_sacker near the clearance 20"):
        boundary_near(LINEAR, damper, 1.0, Boundary(motion, "neimark_sacker"))
