"""Branches that leave at bifurcations, compared with 80-bit arithmetic and with simulations."""

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER, polished_orbit
from references import extended

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit
from impact_damper.orbits.switching import LEAVING, follow_others, met_by, other_branch

# Branch -> damping of the oscillator; mass ratio, clearance and restitution of the damper; W, state
# at W T = pi/2 and period of a stable orbit; least and greatest W.
CASES = {
    "elastic": (0.15, (0.4, 0.7, 1.0), 1.0667, (0.0174, 0.6878, -0.3083, -0.2503), 1, (1.0, 1.3)),
    "inelastic": (0.18, (0.3, 0.9, 0.9), 1.3333, (0.5346, 0.4314, 0.0346, -0.6285), 3, (1.1, 1.6)),
}


def followed(case):
    """Return the branch of a case."""
    damping, (mass_ratio, clearance, restitution), value, state, period, span = CASES[case]
    damper = Damper(mass_ratio, clearance, restitution=restitution)

    def family(value):
        return pack(Oscillator(damping), damper, value)

    return follow_branch(family, find_orbit(family(value), state, period), value, span)


@pytest.fixture(scope="module")
def branches():
    return {case: followed(case) for case in CASES}


def polished(p, state, phase, cycles):
    """Return the orbit over `cycles` forcing cycles near a state, by Newton's method in 80 bits."""
    turn = 2 * np.arccos(extended.Real(-1))
    x = np.array(state, extended.Real)
    begin = extended.Real(phase) / extended.Real(p[FREQUENCY])
    end = begin + extended.Real(cycles) * turn / extended.Real(p[FREQUENCY])
    for _ in range(6):
        run = extended.run(p, x, begin, [end])
        defect = run.states[-1] - x
        x = x + np.linalg.solve((np.eye(4) - run.flow).astype(float), defect.astype(float))
    assert np.max(np.abs(defect)) < 1e-13
    return x


@pytest.mark.thorough
@pytest.mark.parametrize("case", CASES)
def test_80_bit_arithmetic_finds_the_orbit_that_leaves(case, branches):
    """In 80 bits Newton's method finds the other branch's orbit, not a more symmetric orbit."""
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    ends, found = (0, len(branches[case].points) - 1), 0
    for place, event in branches[case].events:
        if event.kind not in LEAVING or place in ends or found == 5:
            continue
        point = other_branch(event)
        if point is None:
            continue
        orbit, sign = point.orbit, 1 if event.kind == "period_doubling" else -1
        x = polished(orbit.p, orbit.state, orbit.phase, orbit.periods)
        beyond = sign * extended_state(orbit.p, x, orbit.phase, orbit.periods / 2)
        assert np.max(np.abs(x - orbit.state)) < 0.05 * np.max(np.abs(beyond - x))
        found += 1
    assert found == 5


def extended_state(p, state, phase, cycles):
    """Return the state `cycles` forcing cycles later, in 80 bits."""
    turn = 2 * np.arccos(extended.Real(-1))
    begin = extended.Real(phase) / extended.Real(p[FREQUENCY])
    end = begin + extended.Real(cycles) * turn / extended.Real(p[FREQUENCY])
    return extended.run(p, state, begin, [end]).states[-1]


def test_the_doubled_branch_of_a_stable_orbit_is_followed_once():
    """A stable branch of period 2 leaves the branch of the large orbit of figure 5 (a)."""

    def family(value):
        return pack(PAPER, DESIGN, value)

    def follow(orbit, value):
        return follow_branch(family, orbit, value, (1.55, 1.8), 60)

    branches = [follow(find_orbit(family(1.7), polished_orbit("large").state), 1.7)]
    follow_others(branches, follow)
    doubled = [number for number, each in enumerate(branches) if each.points[0].orbit.periods == 2]
    met = [met_by(branches, number, edge) for number in doubled for edge in (0, 1)]
    assert met.count(0) == 1
    assert any(point.orbit.stable for number in doubled for point in branches[number].points)
