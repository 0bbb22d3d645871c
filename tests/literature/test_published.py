"""Published numbers and closed forms against the orbits and motions computed here."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from numpy.testing import assert_allclose
from references.masri_caughey import flight_with_speed, two_impact_motions

from impact_damper.data.datasets import is_settled
from impact_damper.model.families import family_of
from impact_damper.model.hertz import DURATION, HertzContact
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.ensemble import settle
from impact_damper.motions.simulate import simulate
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.shooting import find_orbit, shoot

LINEAR = Oscillator(0.02, 1.0, cubic=0.0)
STIFFNESSES = 1e5, 1e6, 1e7
WALLS = list(product([0.4, 0.9], [0.05, 0.1], [20, 80], [0.95, 1.05]))


@pytest.mark.parametrize(("restitution", "mass", "gap", "frequency"), WALLS)
def test_rigid_walls_are_the_limit_of_stiff_contacts(restitution, mass, gap, frequency):
    """The difference to Masri and Caughey's displacement and multiplier falls as r1^(-1/2)."""
    damper = Damper(mass, gap / 2, restitution)
    motions = [each for each in two_impact_motions(LINEAR, damper, frequency) if each.room > 0]
    if not motions:
        pytest.skip("the closed form has no motion")
    motion = min(motions, key=lambda each: abs(each.multipliers[0]))
    ratio = motion.speed / motion.clearance
    _, phase, state = flight_with_speed(LINEAR, damper, frequency, ratio)
    found = []
    for stiffness in STIFFNESSES:
        p = pack(LINEAR, replace(damper, contact_stiffness=stiffness), frequency)
        orbit = _symmetric(p, state, phase)
        multiplier = np.max(np.abs(np.linalg.eigvals(orbit.matrix)))
        found.append((orbit.record["maximum_displacement"], multiplier))
    published = np.array([motion.displacement, abs(motion.multipliers[0])])
    known = slice(None) if motion.stable else slice(1)
    error = (np.array(found) / published - 1)[:, known]
    assert np.all(np.abs(error[-1]) < 1e-3)
    assert_allclose(np.log10(np.abs(error[-1] / error[-2])), -0.5, atol=0.02)
    limit = error[-1] + (error[-1] - error[-2]) / (np.sqrt(10) - 1)
    assert_allclose(limit, 0, atol=1e-6)


def _symmetric(p, state, phase):
    """Return the symmetric orbit near a state, by Newton's method."""
    for _ in range(15):
        orbit = shoot(p, state, 1, phase, symmetric=True)
        state = state + np.linalg.solve(np.eye(4) - orbit.matrix, orbit.defects[0])
    assert orbit.residual < 1e-9 * np.max(np.abs(state))
    return orbit


# Thompson and Stewart's oscillator x'' + 0.08 x' + x^3 = 0.2 cos t has five motions. STARTS has a
# start on each motion, SHARES the share of 10 000 starts in BOX that lead to each motion, by bSTAB
# (Stender and Hoffmann, Nonlinear Dyn. 107, 1451, 2022).
FIVE = Oscillator(0.08, 0.0, force=0.2)
BOX, BSTAB_STARTS = ((-1.0, 1.0), (-0.5, 1.0)), 10_000
STARTS = [(-0.21, 0.02), (1.05, 0.77), (-0.67, 0.02), (-0.46, 0.30), (-0.43, 0.12)]
SHARES = np.array([0.2027, 0.4950, 0.0288, 0.0257, 0.2478])


def test_shares_of_five_motions_differ_by_chance():
    count, p = 2000, pack(FIVE, None, 1.0)
    generator = np.random.default_rng(3)
    drawn = np.column_stack([generator.uniform(*span, count) for span in BOX])
    states = np.tile(np.concatenate([STARTS, drawn]), 2)
    records = settle(np.tile(p, (len(states), 1)), states, Settling())
    assert is_settled(records).all()
    orbits = [
        find_orbit(p, each["state"], int(each["period"])).strobe_states[:, :2]
        for each in records[:5]
    ]
    ends = records["state"][5:, None, :2]
    distance = np.array([np.abs(ends - orbit).max(axis=2).min(axis=1) for orbit in orbits])
    assert distance.min(axis=0).max() < 1e-3
    shares = np.bincount(distance.argmin(axis=0), minlength=5) / count
    error = np.sqrt(SHARES * (1 - SHARES) * (1 / count + 1 / BSTAB_STARTS))
    assert np.all(np.abs(shares - SHARES) < 4 * error)


@pytest.mark.parametrize("cubic", [-1.0, 1.0])
@pytest.mark.parametrize("damping_ratio", [0.02, 0.01, 0.005])
def test_jumps_are_folds_of_the_branch(cubic, damping_ratio):
    """The formulas of Brennan et al., J. Sound Vib. 318, 1250, 2008, assume one harmonic."""
    force = 0.8 * damping_ratio
    down = np.sqrt((1 + np.sqrt(1 + 3 * cubic * force**2 / (4 * damping_ratio**2))) / 2)
    up = np.sqrt(1 + 1.5 ** (4 / 3) * np.cbrt(cubic * force**2))
    oscillator = Oscillator(2 * damping_ratio, 1.0, cubic=cubic, force=force)
    speed = -0.6 * force / (1 - 0.6**2)
    orbit = find_orbit(pack(oscillator, None, 0.6), [0.0, speed, 0.0, speed])
    family, value, span = family_of(oscillator, None, 0.6, "frequency", (0.6, 1.4))
    events = [event.point for _, event in follow_branch(family, orbit, value, span).events]
    large, small = sorted(events, key=lambda each: -each.orbit.record["maximum_displacement"])
    tolerance = 2e-3 * max(1, damping_ratio / 0.005)
    assert_allclose([large.value, small.value], [down, up], rtol=tolerance)


@pytest.mark.parametrize("speed", [0.1, 0.5, 2.0])
def test_impact_on_a_hertz_contact(speed):
    """A linear spring of equal energy has 4/5 of the force, and contacts are 6.7 % longer."""
    machine, ball, half_gap = 12.0, 0.6, 1.0
    contact, mass = HertzContact(0.0264, 210e9, 0.3), ball * machine / (ball + machine)
    hertz, stiffness = contact.impact(speed, mass), contact.stiffness(speed, mass)
    motion = simulate(
        Oscillator(1e-9, 0.0, cubic=0.0, force=0.0),
        Damper(ball / machine, half_gap, 1.0, stiffness / machine),
        1000.0,
        (0.0, 0.0, half_gap * (1 - 1e-6), 1e3 * speed),
        periods=0.5,
        samples=4000,
    )
    duration = float(motion["contact_end"][0] - motion["contact_begin"][0])
    compression = 1e-3 * (np.max(motion["relative_displacement"].values) - half_gap)
    assert_allclose(duration / hertz.duration, np.pi / DURATION, rtol=1e-4)
    assert_allclose(compression, hertz.compression, rtol=1e-4)
    assert_allclose(stiffness * compression / hertz.force, 4 / 5, rtol=1e-4)
