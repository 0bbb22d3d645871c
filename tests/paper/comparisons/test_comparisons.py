"""Numbers that this package compares with published ones, checked by SciPy.

Multipliers are Floquet multipliers.
"""

import numpy as np
import pytest
from helpers.rigid_events import events_of
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp
from scipy.optimize import fsolve

from chatterjee1995.comparisons import basin_shares as published
from chatterjee1995.comparisons.comparison import observed_order
from chatterjee1995.comparisons.duffing import basin_shares, jump_frequencies
from chatterjee1995.comparisons.hertz import BALL, MACHINE, RADIUS, STEEL, hertz_impacts
from chatterjee1995.comparisons.vibro_impact import FIRST, LAST, START, decay_time
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.theory.slow_invariant_manifold import VibroImpactAbsorber


def test_observed_order():
    values = np.array([4.0, 2.0, 1.0])
    assert_allclose(observed_order(values, 3 * values**1.7), 1.7)


def test_decay_with_stiff_contacts_agrees_with_rigid_impacts():
    """SciPy integrates half a cycle after another, with an event at each rigid impact."""
    mass, restitution = 0.02, 0.5
    absorber = VibroImpactAbsorber(mass, restitution)
    oscillator = Oscillator(1e-9, 1.0, cubic=0.0, force=0.0)
    speed = 2 * START / np.pi
    after = (2 * mass - (1 - restitution) / (1 + restitution)) * speed
    # Displacements and velocities of both masses, at 1e-9 from the wall after an impact.
    state = np.array([START - 1, after, START - 1e-9, -speed])
    damper, time, times, sizes = Damper(mass, 1.0, restitution), 0.0, [], []
    while not sizes or sizes[-1] > absorber.amplitude(LAST) * 0.9:
        before = np.hypot(state[0], state[1])
        state, impacts = events_of(oscillator, damper, 1.0, state, time, time + 0.5)
        time += 0.5
        if impacts:
            times.append(impacts[0][0])
            sizes.append((before + np.hypot(state[0], state[1])) / 2)
    first, last = np.interp(-absorber.amplitude([FIRST, LAST]), -np.array(sizes), times)
    assert_allclose(decay_time(absorber, 1e8), last - first, rtol=2e-3)


@pytest.mark.thorough
def test_shares_agree_with_scipy():
    """SciPy integrates all starts, and counts those that end in the motion of a published start."""
    found = basin_shares(150, 7, Settling())
    assert_allclose(sum(each.ours for each in found), 1)
    generator = np.random.default_rng(7)
    starts = np.column_stack([generator.uniform(*span, 150) for span in published.BOX])

    def rate(t, y):
        x, speed = y.reshape(2, -1)
        force = published.FORCE * np.cos(published.FREQUENCY * t)
        return np.concatenate([speed, force - published.DAMPING * speed - x**3])

    given = np.array([motion.start for motion in published.MOTIONS])
    every = np.concatenate([given, starts]).T.ravel()
    turn = 2 * np.pi / published.FREQUENCY
    # Motions of periods 1, 2 and 3 all repeat after six cycles.
    times = turn * np.arange(120, 127)
    run = solve_ivp(rate, (0, times[-1]), every, t_eval=times, rtol=1e-8, atol=1e-10)
    states = run.y.reshape(2, -1, len(times))[:, :, :-1]
    ends, orbits = states[:, len(given) :, 0], states[:, : len(given)]
    distance = np.abs(ends[:, None, :, None] - orbits[:, :, None, :]).max(axis=0).min(axis=-1)
    assert distance.min(axis=0).max() < 1e-3
    counts = np.bincount(distance.argmin(axis=0), minlength=len(given))
    assert_allclose([150 * each.ours for each in found], counts, atol=1e-9)


def test_published_shares_are_within_random_errors():
    for each in basin_shares(2000, 3, Settling()):
        assert abs(each.ours - each.published) < 4 * each.error


@pytest.mark.parametrize("cubic", [-1.0, 1.0])
def test_jumps_are_folds_of_the_period_map(cubic):
    """SciPy finds a fold as a fixed point of the map over a cycle with a multiplier 1."""
    damping, force = 0.02, 0.018
    large, small = jump_frequencies([cubic], [damping], force / damping)

    def period(start, r):
        def rate(t, y):
            spring = y[0] + cubic * y[0] ** 3
            return [y[1], force * np.cos(r * t) - 2 * damping * y[1] - spring]

        run = solve_ivp(rate, (0, 2 * np.pi / r), start, method="DOP853", rtol=1e-11, atol=1e-13)
        return run.y[:, -1]

    def equations(unknowns):
        start, r = unknowns[:2], unknowns[2]
        columns = [(period(start + h, r) - period(start - h, r)) / 2e-5 for h in 1e-5 * np.eye(2)]
        return [*(period(start, r) - start), np.linalg.det(np.eye(2) - np.array(columns))]

    middle = (2 * force / 3) ** (1 / 3)
    for found, start in (
        (large, [0.0, force / (2 * damping)]),
        (small, [-cubic * middle, 0.05]),
    ):
        expected = fsolve(equations, [*start, found.ours], xtol=1e-10)
        assert_allclose(found.ours, expected[2], rtol=1e-6)
        assert np.max(np.abs(equations(expected))) < 1e-7


@pytest.mark.parametrize("speed", [0.1, 1.0])
def test_hertz_formulas_agree_with_an_integrated_impact(speed):
    mass = BALL * MACHINE / (BALL + MACHINE)
    modulus = STEEL.youngs_modulus / (2 * (1 - STEEL.poissons_ratio**2))
    factor = 4 / 3 * modulus * np.sqrt(RADIUS)

    def rate(t, y):
        return [y[1], -factor * max(y[0], 0.0) ** 1.5 / mass]

    def released(t, y):
        return y[0] + 1e-12

    released.terminal, released.direction = True, -1
    run = solve_ivp(
        rate, (0, 1e-2), [0.0, speed], events=released, rtol=1e-10, atol=1e-14, max_step=1e-6
    )
    duration, compression, force = hertz_impacts([speed])
    assert_allclose(duration.published, 1e6 * run.t[-1], rtol=1e-4)
    assert_allclose(compression.published, 1e6 * run.y[0].max(), rtol=1e-4)
    assert_allclose(force.published, 1e-3 * factor * run.y[0].max() ** 1.5, rtol=1e-4)
    assert_allclose(duration.ours / duration.published, 1.0674, atol=1e-3)
