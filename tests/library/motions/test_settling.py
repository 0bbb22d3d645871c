"""Settled motions, chaos, and measures of a motion, each compared with another computation."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from helpers.sampling import sample
from numpy.testing import assert_allclose

from impact_damper.kernel import batch, single
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble, records, strobe_map
from impact_damper.motions.following import follow_stable
from impact_damper.motions.simulate import random_states

NONE = np.empty((0, 4))


def settled(p, state, tolerance=1e-9, patience=300, limit=1500, watched=50):
    """Return the record of the motion from a state at W T = pi/2."""
    settling = Settling(tolerance, patience, limit, watched)
    return ensemble.settle(p[None], np.array(state, float)[None], settling, from_strobe=True)[0]


def divergence_of_neighbours(p, state, periods, skipped=100, apart=1e-7, batches=20):
    """Return the rate at which two neighbouring motions diverge, and its standard error."""
    period, strobe = 2 * math.pi / p[0], 0.5 * math.pi / p[0]
    work = single.workspace()

    def after_period(y):
        y = y.copy()
        advance(p, y, NONE, single.side_of(p, y), strobe, strobe + period, 1e-12, work)
        return y

    y = np.array(state, float)
    other, rates = y + 0.5 * apart, []
    for _ in range(periods):
        y, other = after_period(y), after_period(other)
        size = np.linalg.norm(other - y)
        rates.append(math.log(size / apart) / period)
        other = y + (other - y) * (apart / size)
    means = np.mean(np.reshape(rates[skipped:], (batches, -1)), axis=1)
    return np.mean(means), np.std(means, ddof=1) / math.sqrt(batches)


# The free oscillator has these three motions at W = 2.
@pytest.mark.parametrize(
    "state, period, largest",
    [((2.35, -0.78), 1, 2.376), ((0.03, 0.5), 1, 0.252), ((-0.43, 0.23), 3, 0.893)],
    ids=["resonance", "non-resonance", "subharmonic"],
)
def test_free_motions_settle(state, period, largest):
    p = pack(PAPER, None, 2.0)
    record = settled(p, np.tile(state, 2) + 0.01)
    assert record["outcome"] == records.SETTLED
    assert record["period"] == period
    assert record["contacts"] == 0
    assert abs(record["multiplier"]) < 1
    # by integration a settled motion returns after its period and not before
    back = [strobe_map.period_map(p, record["state"], n, 1e-13)[0] for n in range(1, period + 1)]
    apart = [np.max(np.abs(y - record["state"])) for y in back]
    assert apart[-1] < 1e-8
    assert period == 1 or min(apart[:-1]) > 0.1
    assert_allclose(record["maximum_displacement"], largest, atol=1e-3)
    assert record["asymmetry"] < 1e-7


# Start of a chaotic motion of large amplitude, at a frequency below the band in which the damper
# suppresses large motions.
VIOLENT = pack(PAPER, DESIGN, 1.1), [1.0, 0.5, 0.3, -1.0]


def test_chaos_and_its_exponent():
    """The exponent equals the rate at which two neighbouring motions diverge."""
    p, state = VIOLENT
    record = settled(p, state, patience=1000, limit=3000)
    assert record["outcome"] == records.CHAOTIC
    assert record["period"] == 0
    mean, error = divergence_of_neighbours(p, state, 2100)
    assert abs(record["lyapunov_exponent"] - mean) < 4 * math.hypot(record["lyapunov_error"], error)
    assert mean > 10 * error
    assert 0 < record["lyapunov_error"] < 0.05 * record["lyapunov_exponent"]


def test_exponent_of_a_settled_motion_is_its_multiplier(impacting_orbit):
    """The exponent is log |multiplier| / period. Neighbouring motions diverge at this rate."""
    record = settled(impacting_orbit.parameters, impacting_orbit.state)
    expected = math.log(abs(record["multiplier"])) / (record["period"] * impacting_orbit.period)
    assert record["lyapunov_exponent"] == pytest.approx(expected, rel=1e-12)
    found, _ = divergence_of_neighbours(impacting_orbit.parameters, impacting_orbit.state, 1100)
    assert_allclose(found, expected, rtol=1e-2)


@pytest.mark.parametrize("start, target", [((2.35, -0.78), 2.2), ((0.03, 0.5), 1.2)])
def test_follow_ends_at_the_folds_of_the_free_response(start, target):
    """A motion stays on the branch before the end of the branch, and leaves it beyond the end."""
    p, y = pack(PAPER, None, 2.0), np.tile(start, 2)
    p, (y, multiplier) = follow_stable(p, y, 1, FREQUENCY, target)
    end = p[0]
    assert 1.25 < end < 2.1
    assert_allclose(end, 2.0144439 if target > 2 else 1.3001, atol=5e-5)
    assert_allclose(multiplier, 1, atol=0.01)
    inward = -1 if target > 2 else 1
    sizes = []
    for distance in (1e-3, -1e-3):
        p[0] = end + inward * distance
        record = settled(p, y, limit=5000)
        assert record["outcome"] == records.SETTLED
        sizes.append(record["maximum_displacement"])
    here = records.measured(np.array([end, *p[1:]]), y, 1, 1e-11)["maximum_displacement"]
    assert abs(sizes[0] - here) < 0.2
    assert abs(sizes[1] - here) > 0.8


def test_measures_against_dense_samples(known_orbit):
    """Extremum, contacts and harmonics of one period agree with samples of the motion."""
    record = records.measured(known_orbit.parameters, known_orbit.state, 1, 1e-12)
    count = 4096
    times = known_orbit.strobe + np.arange(count) * known_orbit.period / count
    states, log = sample(known_orbit.parameters, known_orbit.state, known_orbit.strobe, times)
    x, z = states[:, 0], states[:, 2]
    # between two samples |x| exceeds the samples by at most (spacing/2)^2 |x''|/2
    assert -1e-12 < record["maximum_displacement"] - np.max(np.abs(x)) < 1e-5
    assert record["contacts"] == len(log)
    # The record holds c of Re(c exp(i W T)). The transform counts time from the strobe, W T = pi/2.
    # The record is computed from few samples, which resolve contacts poorly: hence `atol`.
    turn = 2 * np.exp(-0.5j * np.pi) / count
    atol = 2e-4 if known_orbit.damper else 1e-8
    first, second = turn * np.fft.rfft(x)[1], turn * np.fft.rfft(z)[1]
    assert_allclose(record["harmonic_displacement"], first, atol=atol)
    assert_allclose(record["harmonic_relative"], second, atol=10 * atol)
    if known_orbit.damper:
        table = records.tabulate(record)
        assert_allclose(table["phase_relative"], np.angle(first / second), atol=2e-2)
        assert_allclose(table["phase_loose"], np.angle(first / (first - second)), atol=2e-2)
    assert np.isnan(records.tabulate(np.zeros(1, records.MOTION))["phase_relative"]).all()


def test_starts_that_settle_early_stay_on_their_orbits():
    damper = Damper(0.12, 2.0, 1.0)
    rows = np.array([pack(PAPER, damper, each) for each in np.linspace(1.4, 2.3, 600)])
    states = random_states(600, 2.0, damper, 5)
    found = ensemble.settle(rows, states, Settling(further=0), from_strobe=True)
    on = (found["outcome"] == records.SETTLED) & (found["period"] < 3)
    assert np.mean(on) > 0.7
    rows, states, found = rows[on], states[on], found[on]
    begins, cycle = np.pi / 2 / rows[:, FREQUENCY], 2 * np.pi / rows[:, FREQUENCY]
    sides, contacts = np.array(list(map(single.side_of, rows, states))), np.zeros(len(rows), int)
    for _ in range(2 * (np.max(found["periods_run"]) // 2 + 100)):
        batch.advance(rows, states, sides, begins, begins + cycle, 1e-9, contacts)
    # A motion of period 2 may be one cycle ahead of the stored state.
    later = found["state"].copy()
    batch.advance(rows, later, sides.copy(), begins, begins + cycle, 1e-9, contacts)
    apart = [np.abs(each - states)[:, :3].max(axis=1) for each in (found["state"], later)]
    assert np.max(np.minimum(*apart)) < 1e-5
