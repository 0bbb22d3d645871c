"""Names of the packed parameters, and that the sources read them by name."""

import re
from pathlib import Path

import numpy as np

import impact_damper
from impact_damper.model import packed
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator

SOURCES = sorted(Path(impact_damper.__file__).parent.rglob("*.py"))
# Lines that read a packed parameter by its number, such as `p[3]`, `parameters[:, 3]`, `orbit.p[0]`
# and `here.on[0]`, or that state the number of parameters as digits, such as `shape (11,)`.
NUMBERED = re.compile(
    r"(?:\b(?:p|parameters)|\.on|\.off)\[(?:[\w.:]+, )?\d\]"
    rf"|[Ss]hapes? \((?:\w+, )*{packed.COUNT},?\)"
)


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


def test_no_source_reads_a_packed_parameter_by_its_number():
    found = [
        f"{path.name}:{number}: {line.strip()}"
        for path in SOURCES
        for number, line in enumerate(path.read_text().splitlines(), 1)
        if NUMBERED.search(line)
    ]
    assert not found
