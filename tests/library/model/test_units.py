"""Physical quantities as numbers, texts with units, and quantities of pint."""

import math
import subprocess
import sys

import pint
import pytest

from impact_damper.model.units import QUANTITIES, check_si, si_value

REGISTRY = pint.UnitRegistry()

# Factors from the definitions of the units (SI brochure; NIST SP 811), not from pint.
KNOWN = [
    ("12 kg", "mass", 12.0),
    ("0.4 mm", "displacement", 4e-4),
    ("1 inch", "displacement", 0.0254),
    ("4 N/mm^3", "cubic_stiffness", 4e9),
    ("500 g mm", "unbalance", 5e-4),
    ("2 g_0", "acceleration", 2 * 9.80665),
    ("0.5 %", "number", 0.005),
    ("0.005", "number", 0.005),
    ("30 1/s", "frequency", 30.0),
]
# A turn is 2 pi rad and one period.
ANGULAR = [("1800 rpm", 30.0), ("188.49555921538757 rad/s", 30.0), ("10800 deg/s", 30.0)]


@pytest.mark.parametrize(("text", "quantity", "value"), KNOWN)
def test_texts_are_converted_by_the_definitions_of_units(text, quantity, value):
    assert si_value("x", text, quantity) == pytest.approx(value, rel=1e-14)


@pytest.mark.parametrize(("text", "value"), ANGULAR)
def test_angular_frequencies_are_divided_by_two_pi(text, value):
    assert si_value("frequency", text, "frequency") == pytest.approx(value, rel=1e-14)
    number, unit = text.split()
    of_pint = float(number) * REGISTRY.Unit(unit)
    assert si_value("frequency", of_pint, "frequency") == pytest.approx(value, rel=1e-14)
    # pint itself does not divide by 2 pi
    assert of_pint.to("Hz").magnitude == pytest.approx(2 * math.pi * value)


def test_numbers_are_si_units():
    assert si_value("gap", 3, "clearance") == 3.0
    assert si_value("gap", 3 * REGISTRY.mm, "clearance") == pytest.approx(0.003, rel=1e-15)


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_dimensions_are_those_of_the_unit(quantity):
    """The exponents of length, time and mass agree with the unit in pint."""
    each = QUANTITIES[quantity]
    found = REGISTRY.Quantity(1.0, each.unit).to_base_units().dimensionality
    expected = {"[length]": each.length, "[time]": each.time, "[mass]": each.mass}
    assert dict(found) == {name: power for name, power in expected.items() if power}
    if each.shown:
        assert (1 * REGISTRY.Unit(each.unit)).to(each.shown).magnitude == each.factor


@pytest.mark.parametrize(
    ("value", "error"),
    [
        ("12 m", ValueError),
        ("nan kg", ValueError),
        ("12 kg; import os", ValueError),
        ("1 kg**9**9**9", ValueError),
        ([12, 13] * REGISTRY.kg, TypeError),
    ],
)
def test_anything_else_is_told_with_the_unit(value, error):
    with pytest.raises(error, match=r"^mass = .*: must be (a number in kg|finite)"):
        si_value("mass", value, "mass")


@pytest.mark.parametrize(
    ("value", "reason"),
    [
        ("12", "this text has no unit"),
        ("12 furlong", "furlong cannot be converted to kg"),
        ("12 kgg", "kgg is no known unit"),
        ("2 * 3 kg", "write the result of the calculation, as one number with a unit"),
    ],
)
def test_a_wrong_unit_is_named(value, reason):
    with pytest.raises(ValueError) as told:
        si_value("mass", value, "mass")
    assert str(told.value).endswith(f" ({reason})")


def test_bounds_are_told_in_the_unit():
    with pytest.raises(ValueError) as told:
        check_si("gap", "4 mm", "clearance", most=0.003, why="it is so wide")
    assert str(told.value) == "gap = '4 mm': must be at most 0.003 m (it is so wide)"


def test_pint_is_imported_for_texts_only():
    code = (
        "import sys, impact_damper as idm;"
        "idm.Machine(mass=1, linear_stiffness=1, damping=.1, force=1).oscillator();"
        "print('pint' in sys.modules, 'numpy' in sys.modules)"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert found.stdout == "False False\n"
