"""Bouncing balls, which fall through the floor in other programs, against closed forms.

SciML/DifferentialEquations.jl, issue 138 (a ball that keeps its energy), issue 551 (restitution
0.8, from 1 m) and issue 696 (restitution 0.5). Here the loose mass is the ball, and one wall is
the floor. A machine without spring, under a force that is constant over the time of the test,
accelerates the gap by g. The distance to the floor then obeys Z2'' = g - r1 (1 + 1/rm) f.
"""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.traces import trace

GRAVITY, MASS_RATIO, CLEARANCE = 9.81, 0.5, 100.0
ACCELERATED = Oscillator(1e-9, 0.0, cubic=0.0, force=GRAVITY)


def ball(height, time, restitution, stiffness):
    """Return states of a ball at rest above the floor, and the times at which contacts begin."""
    damper = Damper(MASS_RATIO, CLEARANCE, restitution, stiffness / (1 + 1 / MASS_RATIO))
    p = pack(ACCELERATED, damper, 100.0)
    p[FREQUENCY] = 1e-9  # lower than the library allows, so that the force stays constant
    state = np.array([0.0, 0.0, CLEARANCE - height, 0.0])
    states, contacts = trace(p, state, 0.0, np.linspace(0.0, time, 2001), 1e-13)
    return states[:, 2:] - [CLEARANCE, 0.0], contacts[:, 1]


@pytest.mark.parametrize("height", [0.1, 1.0, 9.0, 50.0])
def test_no_impact_is_missed_in_50_seconds(height):
    """Impacts are periodic. A period is 2 v/g of flight, and the contact with a loaded spring."""
    stiffness, time = 1e6, 50.0
    states, begun = ball(height, time, 1.0, stiffness)
    speed, natural = np.sqrt(2 * GRAVITY * height), np.sqrt(stiffness)
    contact = 2 / natural * (np.pi - np.arctan(speed * natural / GRAVITY))
    expected = np.arange(speed / GRAVITY, time, 2 * speed / GRAVITY + contact)
    assert_allclose(begun, expected, rtol=1e-7)
    sag = GRAVITY / stiffness
    assert states[:, 0].max() <= sag + np.hypot(sag, speed / natural) + 1e-12


@pytest.mark.parametrize("restitution, height", [(0.5, 2.0), (0.8, 1.0)])
def test_a_ball_that_loses_energy_comes_to_rest_on_the_floor(restitution, height):
    """Each flight is shorter by the factor e. At the end the ball's weight rests on the floor."""
    stiffness = 1e8
    states, begun = ball(height, 8.0, restitution, stiffness)
    fall = np.sqrt(2 * height / GRAVITY)
    flights = 2 * fall * restitution ** np.arange(1, 9)
    assert_allclose(begun[:9], fall + np.cumsum([0.0, *flights]), rtol=2e-3)
    assert_allclose(states[-1], [GRAVITY / stiffness, 0.0], atol=1e-9)
