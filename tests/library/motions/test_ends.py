"""Motions that lead to no orbit escape over a barrier of a softening spring, or come to rest."""

import math

import numpy as np
import pytest

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.motions import legs
from impact_damper.motions.steady import steady_orbit
from impact_damper.motions.strobe_map import POLISH_TOLERANCE, polish

ESCAPED, AT_REST = flag("outcome", "escaped"), flag("outcome", "at_rest")
SOFT = idm.Oscillator(0.01, 1.0, -0.2, 0.0)
BARRIER = math.sqrt(5)
DAMPER = idm.Damper(0.1, 0.5, 0.7)


@pytest.mark.parametrize("share", [0.9, 0.99, 1.01, 1.1, 5.0])
def test_the_barrier_parts_escapes_from_decays(share):
    """The motion begins at rest at `share` times the displacement of the barrier, without force."""
    for side in (1, -1):
        found = idm.steady_motion(SOFT, None, 1.0, (side * share * BARRIER, 0.0))
        assert found["outcome"] == (AT_REST if share < 1 else ESCAPED)
        assert found["maximum_displacement"] == (0 if share < 1 else np.inf)


@pytest.mark.parametrize("damper", [None, DAMPER], ids=["free", "damped"])
def test_every_function_ends_after_an_escape(damper):
    start = (2.4, 0.5, 0.1, 0.0)[: 4 if damper else 2]
    run = idm.simulate(SOFT, damper, 1.0, start, periods=50)
    gone = np.isnan(run["displacement"].values)
    assert 0 < run["escape_time"] < run["time"][-1]
    assert run["escape_time"] == run["time"][np.argmax(gone)] and gone[-1]
    assert np.nanmax(np.abs(run["displacement"])) < 100
    with pytest.raises(ArithmeticError, match="escaped"):
        steady_orbit(SOFT, damper, 1.0, start)
    p = pack(SOFT, damper, 1.0)
    state = np.array([2.4, 0.5, 2.4 if damper is None else 0.1, 0.5])
    assert not polish(p, state, 12, 1e3, POLISH_TOLERANCE)[0]
    assert legs.run(p, state, 0.5, 0.0, 1e-9, 400)[1]["outcome"] == ESCAPED


@pytest.mark.parametrize("damping", [0.02, 0.3, 3.0])
@pytest.mark.parametrize("linear_frequency", [0.0, 1.0])
@pytest.mark.parametrize("damper", [None, DAMPER, idm.Damper(0.5, 3.0)], ids=str)
def test_every_free_motion_comes_to_rest(damping, linear_frequency, damper):
    oscillator = idm.Oscillator(damping, linear_frequency, 1.0, 0.0)
    state = (1.0, 0.5, 0.2, -1.0)[: 4 if damper else 2]
    settling = idm.Settling(limit=100_000)
    found = idm.steady_motion(oscillator, damper, 2.0, state, settling=settling)
    assert found["outcome"] == AT_REST
    assert found["maximum_displacement"] == 0 and found["contacts"] == 0
    with pytest.raises(ArithmeticError, match="at_rest"):
        steady_orbit(oscillator, damper, 2.0, state, settling=settling)
