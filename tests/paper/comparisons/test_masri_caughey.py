"""The closed form of the symmetric motion against rigid impacts located by SciPy's events.

Symbols are as in `system.parameters`.
"""

import numpy as np
import pytest
from helpers.rigid_events import TIGHT, events_of, flight_rate
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from chatterjee1995.comparisons.masri_caughey import two_impact_motions
from chatterjee1995.comparisons.masri_caughey_stability import stability_boundaries
from impact_damper.model.parameters import Damper, Oscillator

CASES = [
    (0.02, 1.0, 0.4, 0.05, 20.0, 1.0),
    (0.02, 1.0, 0.9, 0.1, 10.0, 0.95),
    (0.04, 1.0, 0.7, 0.05, 15.0, 1.05),
    (0.3, 2.0, 0.6, 0.2, 0.6, 1.7),
    (0.5, 0.0, 0.8, 0.3, 1.0, 2.0),
]


def built(case):
    damping, linear, restitution, mass, clearance, frequency = case
    oscillator = Oscillator(damping, linear, cubic=0.0, force=1.3)
    return oscillator, Damper(mass, clearance, restitution), frequency


def absolute(state):
    return np.array([state[0], state[1], state[0] - state[2], state[1] - state[3]])


@pytest.mark.parametrize("case", CASES)
def test_motion_repeats_mirrored(case):
    """Half a period later the state is mirrored, with one impact in between.

    Solutions with negative `room`, whose loose mass would pass a wall, are no motions.
    """
    oscillator, damper, frequency = built(case)
    motions = two_impact_motions(oscillator, damper, frequency)
    assert motions
    for motion in motions:
        assert_allclose(motion.clearance, damper.clearance, rtol=1e-9)
        if motion.room < 0:
            continue
        # The run begins shortly before the impact, so that SciPy sees the event.
        begin = motion.phase / frequency - 0.05
        start = _before(oscillator, frequency, motion, 0.05)
        end, impacts = events_of(
            oscillator, damper, frequency, start, begin, begin + np.pi / frequency
        )
        assert_allclose(end, -start, atol=1e-7 * np.max(np.abs(start)))
        assert [wall for _, wall in impacts] == [-1]
        assert_allclose(impacts[0][0], begin + 0.05, atol=1e-8)


def _before(oscillator, frequency, motion, lead):
    """Return the state of a motion a time `lead` before the impact at Z2 = -d0, by SciPy."""
    rate, time = flight_rate(oscillator, frequency), motion.phase / frequency
    return solve_ivp(rate, (time, time - lead), absolute(motion.impact), **TIGHT).y[:, -1]


@pytest.mark.parametrize("case", CASES)
def test_multipliers_are_those_of_the_map(case):
    """Against the derivative of the mirrored state half a period later, by differences."""
    oscillator, damper, frequency = built(case)
    for motion in two_impact_motions(oscillator, damper, frequency):
        if motion.room < 0:
            continue
        begin = motion.phase / frequency - 0.05
        start = _before(oscillator, frequency, motion, 0.05)
        end = begin + np.pi / frequency
        step = 1e-5 * np.max(np.abs(start))
        columns = []
        for direction in np.eye(4):
            ahead, behind = (
                events_of(oscillator, damper, frequency, start + h * direction, begin, end)[0]
                for h in (step, -step)
            )
            columns.append((behind - ahead) / (2 * step))
        expected = np.linalg.eigvals(np.array(columns).T)
        expected = expected[np.argsort(-np.abs(expected))]
        assert_allclose(np.abs(motion.multipliers), np.abs(expected), rtol=1e-4, atol=1e-4)
        assert_allclose(np.sum(motion.multipliers), np.sum(expected), atol=1e-4)
        determinant = damper.restitution**2 * np.exp(-oscillator.damping * np.pi / frequency)
        assert_allclose(np.prod(motion.multipliers), determinant, rtol=1e-9)


@pytest.mark.parametrize("case", CASES[:2])
def test_largest_displacement(case):
    oscillator, damper, frequency = built(case)
    for motion in two_impact_motions(oscillator, damper, frequency):
        if motion.room < 0:
            continue
        begin, start = motion.phase / frequency - 0.05, _before(oscillator, frequency, motion, 0.05)
        sizes = []
        for share in np.linspace(0, 1, 60):
            end = begin + share * np.pi / frequency
            sizes.append(abs(events_of(oscillator, damper, frequency, start, begin, end)[0][0]))
        assert max(sizes) <= motion.displacement * (1 + 1e-9)
        assert max(sizes) > motion.displacement * 0.99


@pytest.mark.parametrize(("frequency", "expected"), [(1.0, "neimark_sacker"), (0.95, "fold")])
def test_boundaries_separate_stable_from_unstable(frequency, expected):
    """The boundaries have the expected events; between them a disturbed motion returns."""
    oscillator = Oscillator(0.02, 1.0, cubic=0.0)
    damper = Damper(0.05, 20.0, 0.4)
    lower, upper = stability_boundaries(oscillator, damper, frequency)
    assert (lower.event, upper.event) == (expected, "symmetry_breaking")
    assert_allclose(abs(upper.motion.multipliers[0]), 1, atol=1e-9)
    inside = (lower.motion.clearance + upper.motion.clearance) / 2
    stable = two_impact_motions(oscillator, Damper(0.05, inside, 0.4), frequency)
    assert any(each.stable for each in stable)
    motion = next(each for each in stable if each.stable)
    begin, start = motion.phase / frequency - 0.05, _before(oscillator, frequency, motion, 0.05)
    end = begin + 80 * 2 * np.pi / frequency
    damped = Damper(0.05, inside, 0.4)
    state, _ = events_of(oscillator, damped, frequency, start * (1 + 1e-3), begin, end)
    assert_allclose(state, start, atol=1e-4 * np.max(np.abs(start)))


def test_fold_is_the_largest_clearance():
    """The quadratic equation for the speed has a double root at the fold."""
    oscillator = Oscillator(0.02, 1.0, cubic=0.0)
    fold = stability_boundaries(oscillator, Damper(0.05, 20.0, 0.4), 0.95)[0].motion
    inside, outside = (
        len(two_impact_motions(oscillator, Damper(0.05, fold.clearance * share, 0.4), 0.95))
        for share in (1 - 1e-6, 1 + 1e-6)
    )
    assert (inside, outside) == (2, 0)
    assert_allclose(np.min(np.abs(fold.multipliers - 1)), 0, atol=1e-5)


def test_scaling():
    """A force s times as large with a gap s times as wide gives the motion s times as large."""
    damper = Damper(0.1, 12.0, 0.5)
    (one,) = two_impact_motions(Oscillator(0.02, 1.0, cubic=0.0), damper, 1.0)
    larger = Damper(0.1, 36.0, 0.5)
    (three,) = two_impact_motions(Oscillator(0.02, 1.0, cubic=0.0, force=3.0), larger, 1.0)
    assert_allclose(three.impact, 3 * one.impact, rtol=1e-12)
    assert_allclose(three.multipliers, one.multipliers, rtol=1e-9)


def test_nonlinear_spring_is_refused():
    with pytest.raises(ValueError, match="cubic = 1: must be 0"):
        two_impact_motions(Oscillator(0.02, 1.0), Damper(0.1, 12.0, 0.5), 1.0)
