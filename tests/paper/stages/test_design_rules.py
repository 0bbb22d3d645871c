"""Optima of exact orbits compared with clearance sweeps, quadrature and runs; table and figure.

Z1 is the displacement of the primary mass, W the forcing frequency, d0 the clearance, rm the mass
ratio and e the restitution.
"""

import numpy as np
import pytest
from helpers.sampling import gauss, sample
from numpy.testing import assert_allclose

from chatterjee1995.stages.design_rules import QuietMotion, design_rules, first_harmonic
from chatterjee1995.tables.clearance import RULE_NAMES, SWEEPS
from chatterjee1995.tables.clearance import design_rules as table_of
from impact_damper.data.datasets import flag
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions import strobe_map
from impact_damper.motions.response import steady_motion
from impact_damper.orbits.clearance_sweep import clearance_sweep
from impact_damper.theory.optimum_clearance import RULES

PAPER = Oscillator(0.215)
GIVEN = {"mass_ratio": 0.25, "restitution": 0.75, "contact_stiffness": 2000.0}


@pytest.fixture(scope="module")
def grid():
    return design_rules(PAPER, [0.12, 0.25], [0.75, 1.0], [2000.0], [2.0])


@pytest.fixture(scope="module")
def sweeps():
    clearances = np.linspace(0.8, 1.3, 3)
    return {
        f"{e}": clearance_sweep(PAPER, GIVEN | {"restitution": e}, 2.0, clearances, starts=3)
        for e in (0.75, 1.0)
    }


def test_optimum_is_that_of_a_clearance_sweep(grid, sweeps):
    for restitution, sweep in sweeps.items():
        cell = grid.sel(mass_ratio=0.25, restitution=float(restitution)).squeeze()
        cell = cell.sel(criterion="displacement")
        assert_allclose(cell.best_ratio, sweep.optimum_ratio, rtol=1e-5)
        assert_allclose(cell.best_size, 4 * sweep.optimum_displacement, rtol=1e-7)
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
    """With a linear spring and a light loose mass the quiet motion is unstable: a run leaves it."""
    oscillator, frequency = Oscillator(0.215, 1.5), 2.3
    cell = design_rules(oscillator, [mass_ratio], [1.0], [2000.0], [frequency]).squeeze()
    cell = cell.sel(criterion="displacement")
    assert int(cell.best_stability) == flag("best_stability", "stable" if stable else "unstable")
    clearance = float(cell.best_ratio) / (mass_ratio * frequency**2)
    speed = 2 * clearance * frequency / np.pi
    motion = steady_motion(
        oscillator,
        Damper(mass_ratio, clearance),
        frequency,
        state=(0.0, 0.05, 0.0, -speed),
    )
    size = frequency**2 * float(motion.maximum_displacement)
    near = abs(size / float(cell.best_size) - 1) < 1e-4
    assert near == stable


def test_rules_and_excess(grid):
    """The ratio rm W^2 d0 is 1 by rule (18) and pi^2/8 by the first harmonic of straight flight.

    The rule "elastic" holds for e = 1 only. By no rule is max |Z1| below its minimum.
    """
    rules = grid.rule_ratio
    assert np.all(rules.sel(rule="balance") == 1)
    assert_allclose(rules.sel(rule="gap_harmonic"), np.pi**2 / 8)
    assert np.isnan(rules.sel(rule="elastic", restitution=0.75)).all()
    assert np.isfinite(rules.sel(rule="elastic", restitution=1)).all()
    assert np.nanmin(grid.rule_excess) > -1e-9


def test_table_counts(grid, sweeps):
    table = table_of({"design_rules": {"made": grid}, "optimum": sweeps})
    rows = table.set_index(["designs", "quantity that is smallest", "rule for rm Ω^2 d0"])
    for rule in RULES:
        row = rows.loc["made", "max |Z1|", RULE_NAMES[rule]]
        cell = grid.sel(criterion="displacement", rule=rule)
        error = 100 * np.abs(cell.rule_ratio / cell.best_ratio - 1).values
        assert row["number of designs"] == 4 and row["optima found"] == 4
        for most in (1, 10):
            assert row[f"optima within {most} %"] == np.sum(error <= most)
        assert_allclose(row["largest error of d0 [%]"], np.nanmax(error))
    assert rows.loc["all grids, e = 1", "max |Z1|", RULE_NAMES["flight"]]["number of designs"] == 2
    assert rows.loc[SWEEPS, "max |Z1|", RULE_NAMES["flight"]]["optima within 1 %"] == 2
