"""Parameters: their meaning, their places in the packed array, and errors for wrong values."""

import math
from functools import partial

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.model import packed
from impact_damper.model.bounds import check_count, check_number
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator


@pytest.mark.parametrize(
    "make, key, value, allowed",
    [
        (Oscillator, "damping", 0.0, "at least 1e-9 and at most 10 (motions must settle)"),
        (partial(Damper, 0.12), "clearance", math.inf, "finite"),
        (partial(Damper, 0.12, 2.0), "restitution", 0.0, "at least 0.05 and at most 1"),
        (partial(pack, Oscillator(0.2), None), "frequency", 0.0, "at least 0.01"),
    ],
)
def test_values_out_of_range(make, key, value, allowed):
    """The message names the key, the value and what is allowed."""
    with pytest.raises(ValueError) as raised:
        make(**{key: value})
    assert str(raised.value).startswith(f"{key} = {value:g}: must be ")
    assert allowed in str(raised.value)


def test_only_a_linear_spring_is_on_a_shaker():
    with pytest.raises(ValueError, match=r"^cubic = 1: must be 0 with shaker = 0\.5 \(on a moving"):
        Oscillator(0.2, 1.0, shaker=0.5)


def test_checks_return_plain_numbers():
    assert type(check_number("x", np.float32(2.0), above=1)) is float
    assert type(check_count("x", np.int64(2))) is int


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


def test_packed_parameters_stand_in_their_named_places():
    damper = Damper(0.12, 2.0, 0.6, 1500.0)
    p = pack(Oscillator(0.04, 0.9), damper, 1.7)
    expected = {
        "FREQUENCY": 1.7,
        "DAMPING": 0.04,
        "STIFFNESS": 0.9**2,
        "CLEARANCE": 2.0,
        "CONTACT_STIFFNESS": 1500.0,
        "INVERSE_MASS_RATIO": 1 / 0.12,
        "DASHPOT": damper.dashpot,
    }
    assert {name: p[getattr(packed, name)] for name in expected} == expected
    assert p.shape == (packed.COUNT,)
    assert [getattr(packed, name) for name in packed.NAMES] == list(range(packed.COUNT))


def test_without_a_damper_walls_are_out_of_reach_and_exert_no_force():
    p = pack(Oscillator(0.04, 0.9), None, 1.7)
    assert p[packed.CLEARANCE] == np.inf
    assert not np.any(p[[packed.CONTACT_STIFFNESS, packed.INVERSE_MASS_RATIO, packed.DASHPOT]])
