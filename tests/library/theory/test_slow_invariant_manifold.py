"""The slow invariant manifold against impacts on a moving base and exact motions.

The theory is of first order in the mass ratio. Its thresholds, optimum and ring-down are compared
with exact motions with rigid impacts. The error must fall in proportion to the mass ratio.

The ratio of a motion is t = pi w/(2 W d0), with the speed w of the loose mass in flight and the
forcing frequency W. Other symbols are as in `system.parameters`.
"""

import numpy as np
import pytest
from helpers.rigid_events import events_of
from numpy.testing import assert_allclose
from scipy.optimize import brentq, minimize_scalar

from chatterjee1995.comparisons.masri_caughey import flight_with_speed, two_impact_motions
from chatterjee1995.comparisons.masri_caughey_stability import stability_boundaries
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.theory.slow_invariant_manifold import VibroImpactAbsorber

MASS_RATIOS = (0.004, 0.002)


def impacts_on_sine(amplitude, restitution, phase, speed, count):
    """Return phases and speeds before `count` impacts of a free mass with a base A sin(t).

    The mass moves between two walls at the distances -1 and 1 from the base. The motion is mirrored
    at each impact, so that all impacts are at the wall A sin(t) + 1.
    """
    found = []
    for _ in range(count):
        leaving = restitution * speed - (1 + restitution) * amplitude * np.cos(phase)
        start = amplitude * np.sin(phase) + 1

        def gap(t, start=start, leaving=leaving, phase=phase):
            """Return the distance of the mass from the opposite wall a time t after an impact."""
            return start - leaving * t + 1 - amplitude * np.sin(phase + t)

        times = np.linspace(1e-6, 20, 4001)
        values = gap(times)
        k = np.flatnonzero((values[:-1] > 0) & (values[1:] <= 0))[0]
        length = brentq(gap, times[k], times[k + 1], xtol=1e-14)
        phase, speed = phase + length - np.pi, leaving
        found.append((phase, speed))
    return np.array(found)


@pytest.mark.parametrize("restitution", [0.4, 0.6, 0.8])
@pytest.mark.parametrize("share", [0.02, 0.5, 0.98])
def test_manifold_attracts_within_its_range(restitution, share):
    absorber = VibroImpactAbsorber(0.01, restitution)
    low, high = absorber.stable_ratios
    for ratio, stable in ((low + share * (high - low), True), (high * 1.03, False)):
        amplitude = absorber.amplitude(ratio)
        phase = np.arctan2(ratio - 1, -2 / np.pi * (1 - restitution) / (1 + restitution) * ratio)
        speed = 2 * ratio / np.pi
        found = impacts_on_sine(amplitude, restitution, phase + 1e-4, speed, 300)
        distance = np.abs(found[:, 0] - phase)
        assert bool(distance[-2:].max() < 1e-5) == stable


def exact_force(absorber, ratio):
    """Return the force of the exact motion, divided by the spring's force at the clearance."""
    frequency = float(absorber.frequency(ratio))
    oscillator = Oscillator(2 * absorber.damping_ratio, 1.0, cubic=0.0)

    damper = Damper(absorber.mass_ratio, 1.0, absorber.restitution)
    return (
        1
        / flight_with_speed(oscillator, damper, frequency, 2 * ratio * frequency / np.pi).clearance
    )


@pytest.mark.parametrize("ratio", [1.1, 1.3, 1.6])
def test_force_is_met_to_first_order(ratio):
    errors = []
    for mass in MASS_RATIOS:
        absorber = VibroImpactAbsorber(mass, 0.5, 0.5 * mass)
        errors.append(exact_force(absorber, ratio) / absorber.force(ratio) - 1)
    assert abs(errors[1]) < 0.02
    assert_allclose(errors[0] / errors[1], 2, rtol=0.1)


def test_thresholds_are_extremes():
    absorber = VibroImpactAbsorber(0.01, 0.6, 0.005)
    ratios = np.linspace(*absorber.stable_ratios, 100001)
    forces = absorber.force(ratios)
    assert_allclose(absorber.activation().force, forces.min(), rtol=1e-9)
    assert_allclose(absorber.upper_threshold().force, forces.max(), rtol=1e-9)


def test_ends_of_the_manifold_are_met_to_first_order():
    """The errors of the ratios at which motions lose stability fall with the mass ratio."""
    errors = []
    for mass in MASS_RATIOS:
        absorber = VibroImpactAbsorber(mass, 0.5, 0.5 * mass)
        oscillator, damper = Oscillator(mass, 1.0, cubic=0.0), Damper(mass, 1.0, 0.5)
        lower, upper = stability_boundaries(oscillator, damper, 1.0)
        assert (lower.event, upper.event) == ("neimark_sacker", "symmetry_breaking")
        exact = [np.pi / 2 * each.motion.speed / each.motion.clearance for each in (lower, upper)]
        errors.append(np.array(exact) - absorber.stable_ratios)
    assert np.all(np.abs(errors[1]) < 0.02)
    assert_allclose(errors[0] / errors[1], 2, rtol=0.25)


def test_optimum_is_met_to_first_order():
    errors = []
    for mass in MASS_RATIOS:
        absorber = VibroImpactAbsorber(mass, 0.5, 0.5 * mass)
        oscillator, optimum = Oscillator(mass, 1.0, cubic=0.0), absorber.optimum()

        def size(clearance, oscillator=oscillator, mass=mass):
            motions = two_impact_motions(oscillator, Damper(mass, clearance, 0.5), 1.0)
            return min(each.displacement for each in motions)

        bounds = 0.8 * optimum.clearance, 1.2 * optimum.clearance
        found = minimize_scalar(size, bounds=bounds, method="bounded", options={"xatol": 1e-7})
        errors.append([found.x / optimum.clearance - 1, found.fun / optimum.amplitude - 1])
    assert np.all(np.abs(errors[1]) < 0.05)
    assert_allclose(np.divide(*errors), 2, rtol=0.3)


def test_ring_down_is_met_to_first_order():
    """Free decays between rigid walls, from ratio 1.5 to ratio 1.1."""
    errors = []
    for mass in (0.02, 0.01):
        absorber, restitution = VibroImpactAbsorber(mass, 0.6), 0.6
        oscillator = Oscillator(1e-9, 1.0, cubic=0.0, force=0.0)
        damper = Damper(mass, 1.0, restitution)
        loss = (1 - restitution) / (1 + restitution)
        speed = 2 * 1.6 / np.pi
        # Just after an impact at Z2 = -d0, in a state on the manifold.
        state = np.array([0.6, (2 * mass - loss) * speed, 1.6 - 1e-9, -speed])
        times, sizes, time = [], [], 0.0
        while not sizes or sizes[-1] > absorber.amplitude(1.05):
            state, _ = events_of(oscillator, damper, 1.0, state, time, time + np.pi)
            time += np.pi
            times.append(time)
            sizes.append(np.hypot(state[0], state[1]))
        reached = np.interp(-absorber.amplitude([1.5, 1.1]), -np.array(sizes), times)
        errors.append(np.diff(reached)[0] / absorber.ring_down_time(1.5, 1.1) - 1)
    assert abs(errors[1]) < 0.1
    assert abs(errors[1]) < 0.75 * abs(errors[0])
