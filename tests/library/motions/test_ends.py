"""Motions that lead to no orbit escape over a barrier of a softening spring, or come to rest.

Z1 is the displacement of the primary mass.
"""

import math

import numpy as np
import pytest

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.motions import ensemble, legs, records
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


def test_an_outward_force_below_the_barrier_pushes_over_it():
    """The largest restoring force of the spring is 2/3 sqrt(1/(3 * 0.2)) = 0.86.

    The force changes slowly, with the amplitude 1 or 0.8. The motion begins at Z1 = 1, which is the
    equilibrium under the force 0.8.
    """
    oscillator = idm.Oscillator(0.5, 1.0, -0.2, 1.0)
    found = idm.steady_motion(oscillator, None, 0.01, (1.0, 0.0))
    assert found["outcome"] == ESCAPED
    weaker = idm.Oscillator(0.5, 1.0, -0.2, 0.8)
    assert idm.steady_motion(weaker, None, 0.01, (1.0, 0.0))["outcome"] != ESCAPED


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
    path, out = np.zeros((402, 5)), np.zeros(1, records.MOTION)
    legs.run(p, state, 0.5, 0.0, 1e-9, 400, path, out[0], records.NEVER)
    assert out[0]["outcome"] == ESCAPED


def test_a_motion_that_stays_has_no_time_of_escape():
    run = idm.simulate(SOFT, None, 1.0, (1.0, 0.0), periods=5)
    assert np.isnan(run["escape_time"]) and np.isfinite(run["displacement"]).all()
    assert "escape_time" not in idm.simulate(idm.Oscillator(0.1), None, 1.0, periods=1)


@pytest.mark.parametrize("damping", [0.002, 0.05, 0.5])
def test_length_of_a_linear_decay(damping):
    """The energy falls as exp(-h T). The motion is at rest at 1e-9 of the first energy."""
    oscillator, frequency = idm.Oscillator(damping, 3.0, 0.0, 0.0), 5.0
    settling = idm.Settling(limit=20000)
    found = idm.steady_motion(oscillator, None, frequency, (1.0, 0.0), settling=settling)
    assert found["outcome"] == AT_REST
    periods = math.log(1e9) / (damping * 2 * math.pi / frequency)
    assert abs(int(found["periods_run"]) - periods) < 2 + damping / 3 * 5 / damping


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


def test_a_decay_that_is_cut_short_is_unresolved():
    oscillator = idm.Oscillator(1e-5, 1.0, 0.0, 0.0)
    settling = idm.Settling(patience=100, limit=200)
    found = idm.steady_motion(oscillator, None, 1.0, (1.0, 0.0), settling=settling)
    assert found["outcome"] == flag("outcome", "unresolved")
    assert 0.9 < found["maximum_displacement"] < 1.0


@pytest.mark.parametrize("oscillator", [SOFT, idm.Oscillator(0.2, 1.0, 0.5, 0.0)], ids=str)
def test_responses_hold_one_escape_and_one_rest(oscillator):
    """Starts lie on both sides of the barrier. All escapes count as one motion, as do all rests."""
    found = idm.frequency_response(oscillator, None, [0.9, 1.0], starts=12, radius=4.0)
    outcomes = found["outcome"].values
    assert set(np.unique(found["run_outcome"])) == (
        {ESCAPED, AT_REST} if oscillator is SOFT else {AT_REST}
    )
    assert np.all(np.sum(outcomes == AT_REST, axis=1) == 1)


def test_records_of_runs_side_by_side():
    """Motions that settle have the same records whether or not escaping motions are run too."""
    soft, hard = pack(SOFT, DAMPER, 1.0), pack(idm.Oscillator(0.3, 1.0), DAMPER, 1.0)
    random = np.random.default_rng(3)
    states = random.uniform(-1, 1, (60, 4)) * [3.0, 1.0, 0.4, 1.0]
    parameters = np.where(np.arange(60)[:, None] % 2, hard, soft)
    mixed = ensemble.settle(parameters, states)
    alone = ensemble.settle(parameters[1::2], states[1::2])
    assert np.array_equal(mixed["state"][1::2], alone["state"])
    assert np.sum(mixed["outcome"] == ESCAPED) > 5
