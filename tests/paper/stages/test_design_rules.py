"""Optima of exact orbits compared with clearance sweeps, quadrature and runs."""

import numpy as np
import pytest
from helpers.sampling import gauss, sample
from numpy.testing import assert_allclose

from chatterjee1995.stages.design_rules import QuietMotion, design_rules, first_harmonic
from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions import strobe_map
from impact_damper.motions.steady import steady_motion
from impact_damper.orbits.clearance_sweep import clearance_sweep

PAPER = Oscillator(0.215)


@pytest.fixture(scope="module")
def grid():
    return design_rules(PAPER, [0.12, 0.25], [0.75, 1.0], [2000.0], [2.0])


def test_optimum_is_that_of_a_clearance_sweep(grid):
    for restitution in (0.75, 1.0):
        damper = {"mass_ratio": 0.25, "restitution": restitution, "contact_stiffness": 2000.0}
        sweep = clearance_sweep(PAPER, damper, 2.0, [0.8, 1.05, 1.3], starts=3)
        cell = grid.sel(mass_ratio=0.25, restitution=restitution, criterion="displacement")
        cell = cell.squeeze()
        assert_allclose(cell.best_ratio, sweep.optimum_ratio, rtol=1e-5)
        assert int(cell.best_kind) == int(sweep.optimum_kind)


def test_first_harmonic_by_quadrature_between_contacts():
    motion = QuietMotion(PAPER, Damper(0.12, 2.0), 2.0)
    p = pack(PAPER, Damper(0.12, 2.0), 2.0)
    y = np.array([0.006, 0.187, 0.002, -2.408])
    assert strobe_map.polish(p, y, 1, 0.1, 1e-13)[0]
    start = np.pi / 4
    log = sample(p, y, start, [start + np.pi])[1]
    nodes, weights = gauss([start, *log[:, 1:3].ravel(), start + np.pi], 0.05)
    z1 = sample(p, y, start, nodes)[0][:, 0]
    exact = 2 / np.pi * np.sum(weights * z1 * np.exp(-2j * nodes))
    assert_allclose(first_harmonic(p, y), exact, atol=1e-6)
    assert_allclose(motion.at(0.96)[1], 4 * abs(exact), rtol=1e-3)


@pytest.mark.parametrize(("mass_ratio", "stable"), [(0.12, False), (0.4, True)])
def test_stability_agrees_with_a_run(mass_ratio, stable):
    """If the quiet motion is unstable (linear spring, light loose mass), a run leaves it."""
    oscillator, frequency = Oscillator(0.215, 1.5), 2.3
    cell = design_rules(oscillator, [mass_ratio], [1.0], [2000.0], [frequency]).squeeze()
    cell = cell.sel(criterion="displacement")
    assert int(cell.best_stability) == flag("best_stability", "stable" if stable else "unstable")
    clearance = float(cell.best_ratio) / (mass_ratio * frequency**2)
    speed = 2 * clearance * frequency / np.pi
    start = 0.0, 0.05, 0.0, -speed
    motion = steady_motion(oscillator, Damper(mass_ratio, clearance), frequency, start)
    size = frequency**2 * float(motion.maximum_displacement)
    orbit = QuietMotion(oscillator, Damper(mass_ratio, 1.0), frequency).at(float(cell.best_ratio))
    assert (abs(size / orbit[0] - 1) < 1e-4) == stable


def test_rules_and_excess(grid):
    """The ratio rm W^2 d0 is 1 by (18) and pi^2/8 by the first harmonic of straight flight."""
    rules = grid.rule_ratio
    assert np.all(rules.sel(rule="balance") == 1)
    assert_allclose(rules.sel(rule="gap_harmonic"), np.pi**2 / 8)
    assert np.isnan(rules.sel(rule="elastic", restitution=0.75)).all()
    assert np.isfinite(rules.sel(rule="elastic", restitution=1)).all()
    assert np.nanmin(grid.rule_excess) > -1e-9
