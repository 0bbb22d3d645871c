"""Undecided motions that are run longer: spectra, multipliers, and rotation numbers."""

import math

import numpy as np
import pytest
from helpers.known_orbits import INELASTIC, PAPER
from helpers.sampling import sample

from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble, records, strobe_map, undecided
from impact_damper.motions.following import follow_stable
from impact_damper.motions.undecided import AGREEMENT, find_rotation

NEVER = np.zeros(1, bool)


def examined(p, state, limit=1500):
    """Return the record of a motion that `name_undecided` continues from a state at the strobe."""
    found = np.zeros(1, records.MOTION)
    found["state"] = state
    undecided.name_undecided(p[None], found, limit, 100_000, NEVER)
    return found[0]


@pytest.fixture(scope="module", params=[1.45, 1.5])
def torus(request):
    """Return parameters and records of a quasi-periodic motion that random starts lead to."""
    p = pack(PAPER, INELASTIC, request.param)
    starts = np.random.default_rng(3).uniform(-1, 1, (96, 4))
    found = ensemble.settle(np.tile(p, (len(starts), 1)), starts, Settling())
    return p, found[found["outcome"] == records.QUASI_PERIODIC]


def test_frequencies_are_those_of_the_spectrum(torus):
    """The spectrum's highest lines are at k first + m second frequency, with integers k and m."""
    p, found = torus
    assert len(found) > 0
    record, period, size = found[0], 2 * math.pi / p[FREQUENCY], 2**14
    assert record["frequency_error"] < 1e-8 * p[FREQUENCY]
    assert abs(record["lyapunov_exponent"]) < 3 * record["lyapunov_error"]
    begin = strobe_map.strobe_time(p)
    states, _ = sample(p, record["state"], begin, begin + np.arange(size) * period / 4)
    window = np.hanning(size)
    spectrum = np.abs(np.fft.rfft(states[:, 0] * window))
    step = 2 * math.pi / (size * period / 4)
    peaks = 1 + np.flatnonzero(np.diff(np.sign(np.diff(spectrum))) < 0)
    peaks = peaks[np.argsort(spectrum[peaks])[::-1][:12]]
    first, second = record["first_frequency"], record["second_frequency"]
    lines = np.add.outer(np.arange(-9, 10) * second, np.arange(-12, 13) * first)
    apart = np.abs(lines[None] - peaks[:, None, None] * step)
    assert np.max(np.min(apart, axis=(1, 2))) < step
    # some of the lines contain the second frequency
    orders = np.argmin(apart.reshape(len(peaks), -1), axis=1) // 25 - 9
    assert np.sum(orders != 0) >= 3


def test_torus_turns_as_the_orbit_it_splits_off_from():
    """At a Neimark-Sacker point with multiplier exp(i a) the rotation number is a/(2 pi)."""
    p = pack(PAPER, INELASTIC, 1.6)
    state = np.array([0.7796012138, 0.1703671945, 0.8163322819, -0.9718488376])
    p, (state, multiplier) = follow_stable(p, state, 3, FREQUENCY, 1.55)
    assert abs(multiplier) == pytest.approx(1, abs=1e-6) and multiplier.imag > 0.5
    onset, angle = p[FREQUENCY], np.angle(multiplier) / (2 * np.pi)
    numbers = []
    for below in (2e-3, 1e-3):
        p[FREQUENCY] = onset - below
        record = examined(p, state + np.array([1e-3, 0, 0, 0]))
        assert record["outcome"] == records.QUASI_PERIODIC
        assert record["first_frequency"] == pytest.approx(p[FREQUENCY] / 3, rel=1e-12)
        numbers.append(record["second_frequency"] / record["first_frequency"])
    assert (numbers[0] - angle) / (numbers[1] - angle) == pytest.approx(2, abs=0.1)
    assert 2 * numbers[1] - numbers[0] == pytest.approx(angle, abs=5e-6)


def test_long_period():
    """Settling looks for periods up to 12. This motion returns after 15 cycles, not before."""
    p = pack(Oscillator(0.107), Damper(0.12, 1.063), 2.555)
    start = np.array([-0.07209, 0.13602, -0.69963, -2.05575])
    found = [
        ensemble.settle(
            p[None],
            start[None],
            Settling(patience=100, limit=400, further=further),
            from_strobe=True,
        )[0]
        for further in (0, 400)
    ]
    assert [each["outcome"] for each in found] == [records.UNRESOLVED, records.SETTLED]
    orbit = found[1]
    assert orbit["period"] == 15 and abs(orbit["multiplier"]) < 1
    begin, period = strobe_map.strobe_time(p), 2 * math.pi / p[FREQUENCY]
    states, _ = sample(p, orbit["state"], begin, begin + np.arange(1, 16) * period)
    apart = np.max(np.abs(states - orbit["state"]), axis=1)
    assert apart[-1] < 1e-9 and np.min(apart[:-1]) > 1e-3


def test_drifting_mass_has_its_own_name():
    """The primary mass is on its free orbit. The loose mass reaches a wall after 11 000 cycles."""
    p = pack(PAPER, Damper(0.12, 2.0), 2.0)
    free = ensemble.settle(pack(PAPER, None, 2.0)[None], np.zeros((1, 4)), Settling())[0]
    state = np.array([*free["state"][:2], *free["state"][:2]])
    state[3] += 5e-5
    rows, settling = p[None], Settling(patience=100, limit=200)
    record = ensemble.settle(rows, state[None], settling, from_strobe=True)[0]
    assert record["outcome"] == records.DRIFTING
    assert record["period"] == 1 and record["contacts"] == 0
    assert abs(record["maximum_displacement"] - free["maximum_displacement"]) < 1e-9
    assert abs(record["multiplier"] - free["multiplier"]) < 1e-6
    # with a longer limit the loose mass touches a wall
    later = Settling(patience=300, limit=20_000)
    assert ensemble.settle(rows, state[None], later)[0]["outcome"] != records.DRIFTING


GOLDEN = (math.sqrt(5) - 1) / 2


def on_curve(number, count=3000):
    """Return points that rotate by `number` revolutions a step on an asymmetric closed curve."""
    angle = 2 * np.pi * number * np.arange(count)
    return 1 + 2j + np.exp(1j * angle) + 0.3 * np.exp(-1j * angle) + 0.1 * np.exp(2j * angle)


@pytest.mark.parametrize("number", [1 - GOLDEN, 0.1 / math.pi, 1 / math.sqrt(5)])
@pytest.mark.parametrize("sense", [1, -1])
def test_rotation_of_a_curve(number, sense):
    found, error = find_rotation(on_curve(sense * number))
    assert error <= AGREEMENT
    assert abs(found - number) < 1e-12


def test_chaotic_points_are_no_curve():
    """Points of Henon's map have no rotation number."""
    points = [0.1 + 0.1j]
    for _ in range(3000):
        x, y = points[-1].real, points[-1].imag
        points.append(complex(1 - 1.4 * x * x + y, 0.3 * x))
    assert find_rotation(np.array(points)) is None
