"""One contact in closed form against its differential equation, energy and impulse."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import quad, solve_ivp

from chatterjee1995.methods.contact_law import contact, pull_time
from impact_damper.model.exit_rules import damping_ratio

CASES = [(e, g) for e in (0.1, 0.3, 0.75, 0.95, 1.0) for g in (-5, -0.3, 0, 0.02, 0.3, 2)]
LONG = 20.0


def integrated(restitution, load, rule):
    """Return SciPy's solution of a contact, and (time, penetration, speed) at its end, or None."""
    z = damping_ratio(restitution)

    def rate(_, y):
        return [y[1], load - 2 * z * y[1] - y[0]]

    def end(s, y):
        return (y[0] if rule == "zero_penetration" else y[0] + 2 * z * y[1]) if s > 1e-9 else 1.0

    end.terminal, end.direction = True, -1
    found = solve_ivp(
        rate,
        (0, LONG),
        [0, 1],
        "DOP853",
        rtol=1e-12,
        atol=1e-14,
        events=end,
        dense_output=True,
        max_step=0.1,
    )
    return found, (found.t_events[0][0], *found.y_events[0][0]) if len(found.t_events[0]) else None


@pytest.mark.parametrize("rule", ["zero_penetration", "no_tension"])
@pytest.mark.parametrize(("restitution", "load"), CASES)
def test_against_its_differential_equation(restitution, load, rule):
    _, expected = integrated(restitution, load, rule)
    found = contact(restitution, load, rule)
    if expected is None:
        assert found.outcome == "no_release"
        assert found.duration == math.inf
        return
    duration, left, speed = expected
    assert found.duration == pytest.approx(duration, abs=1e-9)
    square = speed**2 - 2 * load * left
    assert found.outcome == ("released" if square >= 0 else "falls_back")
    assert_allclose(found.departure, math.sqrt(square) if square >= 0 else np.nan, atol=1e-9)


@pytest.mark.parametrize(("restitution", "load"), [(0.3, 0.05), (0.3, -1), (0.75, 0.2), (0.9, -3)])
def test_energy_and_pull(restitution, load):
    """Energy lost in the dashpot and time of the pull are compared with numerical integrals."""
    z = damping_ratio(restitution)
    solution, (end, *_) = integrated(restitution, load, "zero_penetration")
    begin = integrated(restitution, load, "no_tension")[1][0]
    speed = contact(restitution, load, "zero_penetration").departure

    lost = quad(lambda s: 2 * z * solution.sol(s)[1] ** 2, 0, end)[0]
    assert 1 - speed**2 == pytest.approx(2 * lost, abs=1e-9)
    assert pull_time(restitution, load) == pytest.approx((end - begin) / end, abs=1e-9)
