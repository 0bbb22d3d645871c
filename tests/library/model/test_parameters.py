"""Parameters: their meaning, their places in the packed array, and errors for wrong values."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.model import packed
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator, describe
from impact_damper.model.settling import Settling


@pytest.mark.parametrize("mass_ratio", [0.01, 0.25, 10.0])
@pytest.mark.parametrize("restitution", [0.05, 0.3, 0.75, 0.9, 1.0])
def test_damping_of_the_contact_gives_the_restitution(mass_ratio, restitution):
    """Equation (25) against e = exp(-pi z/sqrt(1 - z^2)), z being the relative damping ratio."""
    damper = Damper(mass_ratio, 1.0, restitution)
    z = damper.contact_damping * math.sqrt(1 + mass_ratio)
    assert_allclose(math.exp(-math.pi * z / math.sqrt(1 - z**2)), restitution, rtol=1e-14)
    # The relative motion with the penetration q solves q'' + (1 + 1/rm)(dashpot q' + r1 q) = 0.
    inverse = 1 + 1 / mass_ratio
    natural = math.sqrt(damper.contact_stiffness * inverse)
    assert_allclose(damper.dashpot * inverse, 2 * z * natural, atol=1e-14)


def test_without_a_damper_walls_are_out_of_reach_and_exert_no_force():
    p = pack(Oscillator(0.04, 0.9), None, 1.7)
    assert p[packed.CLEARANCE] == np.inf
    assert not np.any(p[[packed.CONTACT_STIFFNESS, packed.INVERSE_MASS_RATIO, packed.DASHPOT]])


def test_datasets_store_the_parameters_of_a_run():
    stored = describe(Oscillator(0.2), Damper(0.1, 2.0), Settling(limit=700))
    assert {"damping", "clearance", "gravity", "friction"} < stored.keys()
    assert stored["limit"] == 700
