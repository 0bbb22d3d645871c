"""Optimum clearance compared with simulations and closed forms; ends of sweep and branch."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.optimize import brentq

from impact_damper.data.datasets import flag, load, save
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.simulate import simulate
from impact_damper.orbits.clearance_sweep import NEAR_MINIMUM, clearance_sweep, minimum_table
from impact_damper.theory.single_harmonic import contact_amplitude

PAPER = Oscillator(0.215)
ELASTIC = {"mass_ratio": 0.12, "restitution": 1.0, "contact_stiffness": 2000.0}
INELASTIC = {"mass_ratio": 0.25, "restitution": 0.75, "contact_stiffness": 2000.0}
CASES = [ELASTIC, INELASTIC]


def run(damper, first, last, points=9, frequency=2.0, **options):
    options = {"starts": 6} | options
    return clearance_sweep(PAPER, damper, frequency, np.linspace(first, last, points), **options)


@pytest.fixture(scope="module")
def sweeps():
    return [run(ELASTIC, 1.2, 2.8), run(INELASTIC, 0.5, 1.3)]


def settled(damper, clearance):
    """Return max |Z1| over the last two cycles of a long run to the quiet motion."""
    flight = 4 * clearance / np.pi
    motion = simulate(
        PAPER,
        Damper(clearance=clearance, **damper),
        2.0,
        (0.0, 0.0, 0.95 * clearance, -flight),
        periods=500,
        samples=400,
    )
    return float(np.abs(motion.displacement.values[-800:]).max())


@pytest.mark.parametrize("case", [0, 1])
def test_near_range_is_where_the_minimum_is_exceeded_by_a_tenth(sweeps, case):
    sweep = sweeps[case]
    for clearance in sweep.near_clearance.values:
        ratio = settled(CASES[case], clearance) / float(sweep.optimum_displacement)
        assert_allclose(ratio, NEAR_MINIMUM, rtol=2e-3)


def test_kind_of_minimum(sweeps):
    """With e = 1 the minimum is a kink, with e < 1 it is smooth."""
    assert [int(sweep.optimum_kind) for sweep in sweeps] == [
        flag("optimum_kind", "kink"),
        flag("optimum_kind", "smooth"),
    ]


@pytest.mark.thorough
def test_analytical_optimum_has_no_amplitude_and_tends_to_the_rule():
    """By harmonic balance Z1 has the amplitude 0 at the optimum.

    This requires rm W^2 b = 1 and r1 B(b) = 1. Here b is the amplitude of Z2. The amplitude r1 B(b)
    of the contact force grows as (b - d0)^(3/2).
    """
    excess = []
    for stiffness in (2e3, 2e5, 2e7):
        damper = ELASTIC | {"contact_stiffness": stiffness}
        sweep = run(damper, 1.9, 2.3, points=3, method="harmonic_balance")
        rule = float(sweep.rule_clearance)
        expected = brentq(
            lambda d0, b=rule, r1=stiffness: r1 * contact_amplitude(b, d0)[0] - 1, 0.5 * rule, rule
        )
        assert_allclose(sweep.analytical_optimum, expected, rtol=1e-9)
        excess.append(1 - float(sweep.analytical_optimum) / rule)
    assert_allclose(np.divide(excess[:-1], excess[1:]), 100 ** (2 / 3), rtol=0.02)


@pytest.mark.thorough
def test_straight_flight_ratio_is_the_limit_of_rigid_walls_at_high_frequency():
    damper = {"mass_ratio": 0.12, "restitution": 0.75, "contact_stiffness": 1e8}
    clearances = np.linspace(0.4, 1.6, 7) / (0.12 * 30.0**2)
    short = {"starts": 32, "radius": 2 * clearances[-1], "settling": Settling(limit=600, further=0)}
    sweep = clearance_sweep(Oscillator(0.1), damper, 30.0, clearances, **short)
    assert_allclose(sweep.optimum_ratio, sweep.straight_flight_ratio, rtol=0.01)


def test_optimum_at_the_edge_of_the_sweep():
    sweep = run(ELASTIC, 2.6, 3.0, points=3)
    assert sweep.optimum_kind == flag("optimum_kind", "edge")
    assert_allclose(sweep.optimum_clearance, 2.6, rtol=1e-6)


def test_no_quiet_motion(tmp_path):
    """Beyond the fold of the quiet branch there is no quiet motion."""
    sweep = run(INELASTIC | {"mass_ratio": 0.12}, 2.6, 3.0, points=3)
    assert np.all(sweep.quiet_status == flag("quiet_status", "absent"))
    assert sweep.optimum_kind == flag("optimum_kind", "not_found")
    save(sweep, tmp_path / "sweep.nc")
    assert load(tmp_path / "sweep.nc").identical(sweep)


def test_optimum_at_the_end_of_the_branch():
    """On a branch that ends at d0 = 1.3 the displacement equals the clearance."""
    values = np.array([1.3, 2.0, 3.0])
    table = minimum_table(values, values, float, (1.0, 3.0))
    assert table["optimum_kind"] == flag("optimum_kind", "jump")
    assert_allclose(table["optimum_clearance"], 1.3)
    assert_allclose(table["near_clearance"], [1.3, 1.43])


def test_rules_without_motions():
    found = clearance_sweep(PAPER, ELASTIC, 2.0, [2.0, 2.1], method="harmonic_balance")
    assert_allclose(found.rule_clearance, 1 / (0.12 * 4))
