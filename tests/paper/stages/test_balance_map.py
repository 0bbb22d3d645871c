"""Maps of harmonic balance compared with exact motions, and their counts."""

import numpy as np
import pytest
from helpers.known_orbits import PAPER

from chatterjee1995.stages.balance_map import balance_map
from impact_damper.data.datasets import decode
from impact_damper.model.parameters import Damper
from impact_damper.model.settling import Settling
from impact_damper.motions.simulate import simulate
from impact_damper.motions.steady import steady_motion
from impact_damper.theory.design_rule import peak_frequency

FIXED = {"damping": 0.215, "mass_ratio": 0.12, "clearance": 2.0}
RATIOS = np.linspace(0.4, 1.2, 9)
SETTLING = Settling(patience=100, limit=800, watched=20)


@pytest.fixture(scope="module")
def over_restitution():
    return balance_map("restitution", [0.6, 0.8, 1.0], RATIOS, FIXED, settling=SETTLING)


def names(data, variable):
    return decode(data[variable]).values


def test_the_orbit_exists_only_before_the_fold_with_restitution(over_restitution):
    """At e = 0.6 and W = Wp harmonic balance predicts a stable quiet orbit, but there is none."""
    verdict = names(over_restitution, "quiet_verdict")
    design = np.argmin(np.abs(RATIOS - 1))
    assert verdict[0, design] == "stable_absent"
    assert verdict[2, design] == "stable_stable"
    end = over_restitution["quiet_end"].values[0]
    assert end[0] < 0.7 < end[1] < 1
    assert end[1] == pytest.approx(over_restitution["straight_flight_end"].values[0], rel=0.05)


def test_displacement_is_that_of_a_simulation(over_restitution):
    row, column = 2, np.argmin(np.abs(RATIOS - 1))
    frequency = RATIOS[column] * peak_frequency(PAPER)
    damper = Damper(0.12, 2.0)
    steady = steady_motion(PAPER, damper, frequency, (1, 0.5, 0, 0))
    begin = {"start": np.pi / 2 / frequency, "samples": 5000}
    motion = simulate(PAPER, damper, frequency, steady["state"].values, **begin)
    found = float(over_restitution["quiet_orbit_displacement"][row, column])
    assert np.abs(motion["displacement"].values).max() == pytest.approx(found, rel=1e-5)
