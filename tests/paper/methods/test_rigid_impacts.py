"""The rigid-impact model against SciPy and against compliant contact."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER, polished_orbit
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from chatterjee1995.methods.rigid_impacts import MOST_IMPACTS, rigid_map, rigid_orbit
from impact_damper.model.packed import DASHPOT, pack
from impact_damper.model.parameters import Damper
from impact_damper.motions.strobe_map import period_map

CASES = [(DESIGN, "design"), (INELASTIC, "inelastic")]


def rigid(damper, frequency, oscillator=PAPER):
    p = pack(oscillator, damper, frequency)
    p[DASHPOT] = 0.0
    return p


def by_scipy(damper, frequency, y):
    """Return the state after a period of the rigid model by SciPy, and the largest sampled |Z1|."""
    mass, e = damper.mass_ratio, damper.restitution
    t, end = 0.5 * math.pi / frequency, 2.5 * math.pi / frequency
    y, largest = np.array(y), 0.0

    def rate(t, y):
        a = math.cos(frequency * t) - PAPER.damping * y[1] - y[0] ** 3
        return [y[1], a, y[3], a]

    def wall(side):
        def gap(_, y):
            return side * y[2] - damper.clearance

        gap.terminal, gap.direction = True, 1
        return gap

    while t < end:
        run = solve_ivp(
            rate, (t, end), y, "DOP853", rtol=1e-13, atol=1e-14, events=[wall(1), wall(-1)],
            dense_output=True, max_step=0.05,
        )  # fmt: skip
        largest = max(largest, np.max(np.abs(run.sol(np.linspace(t, run.t[-1], 4001))[0])))
        t, y = run.t[-1], run.y[:, -1].copy()
        if run.status == 1:
            y[1] -= mass / (1 + mass) * (1 + e) * y[3]
            y[3] *= -e
    return y, largest


@pytest.mark.parametrize(("damper", "name"), CASES)
@pytest.mark.parametrize("frequency", [2.0, 2.3])
def test_against_scipy(damper, name, frequency):
    """At W = 2.3 the largest |Z1| is at an impact, at which Z1' does not vanish."""
    y = polished_orbit(name).state
    state, _, impacts, _, _, largest = rigid_map(
        rigid(damper, frequency), damper.restitution, y, 1e-13
    )
    expected, size = by_scipy(damper, frequency, y)
    assert impacts > 0
    assert_allclose(state, expected, atol=1e-9)
    assert largest == pytest.approx(size, abs=1e-6)


@pytest.mark.parametrize(("damper", "name"), CASES)
def test_compliant_contact_comes_to_it(damper, name):
    """Differences to compliant walls, of the state and its derivative, fall as r1^(-1/2)."""
    y = polished_orbit(name).state
    state, matrix, *_ = rigid_map(rigid(damper, 2.0), damper.restitution, y, 1e-13)
    errors = []
    for stiffness in (1e6, 1e8):
        each = Damper(damper.mass_ratio, damper.clearance, damper.restitution, stiffness)
        soft, soft_matrix, _ = period_map(pack(PAPER, each, 2.0), y, 1, 1e-13)
        errors.append([np.max(np.abs(soft - state)), np.max(np.abs(soft_matrix - matrix))])
    assert_allclose(np.divide(*errors), 10, rtol=0.1)


def test_chatter_ends_with_a_status():
    """A loose mass that is pressed to a wall, and loses nearly all speed, impacts without end."""
    damper = Damper(0.12, 2.0, 0.05)
    y = np.array([-2.0, 0.0, 1.999, 0.0])
    assert rigid_map(rigid(damper, 0.5), 0.05, y, 1e-9)[2] == MOST_IMPACTS
    orbit, status = rigid_orbit(PAPER, damper, 0.5, y, 0.1)
    assert orbit is None
    assert status == "chatter"
