"""Costs of motions compared with SciPy in SI units, and Hertz's formulas."""

import math

import numpy as np
import pytest
from helpers.sampling import sample
from helpers.si_motions import SiMotion

import impact_damper as idm
from impact_damper.design.costs import measured_costs, pressure_costs
from impact_damper.model.packed import FREQUENCY, pack
from impact_damper.motions.strobe_map import strobe_time

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005}
LINEAR = idm.Machine(**SPRING, force=40)
HARD = idm.Machine(**SPRING, cubic_stiffness=4e9, unbalance=0.003)
HERTZ = idm.HertzContact("2 cm", "210 GPa", 0.3, "400 MPa")


def damper_of(machine, **others):
    given = {"mass": 0.6, "gap": 0.008, "restitution": 0.7, "contact_stiffness": 2e7}
    return machine.damper(**given | others)


def packed(machine, damper, frequency):
    """Return the packed parameters of a machine at a frequency (Hz)."""
    turning = machine.scales.from_si(frequency, "frequency")
    return pack(machine.oscillator(), damper.scaled(machine.scales), turning)


def by_scipy(machine, damper, frequency, state, time):
    """Return (last state, loss in contacts) as one vector, largest force, largest acceleration."""
    angular = 2 * math.pi * frequency
    amplitude = machine.force if machine.force else machine.unbalance * angular**2
    motion = SiMotion(machine, damper, lambda t: amplitude * math.cos(angular * t))
    forces, accelerations = [], []
    begin = 0.25 / frequency
    for wall, run in motion.run(state, begin, begin + time):
        for moment in np.linspace(run.t[0], run.t[-1], 2000):
            here = run.sol(moment)
            forces.append(abs(motion.push(here, wall)))
            accelerations.append(abs(motion.slope(moment, here, wall)[1]))
    return run.y[:, -1], max(forces), max(accelerations)


@pytest.mark.parametrize(
    ("machine", "gap", "frequency"), [(LINEAR, 0.008, 20.5), (HARD, 0.002, 24.0)]
)
def test_costs_are_those_that_scipy_integrates_in_si_units(machine, gap, frequency):
    damper = damper_of(machine, gap=gap)
    steady = idm.steady_motion(machine, damper, frequency, (0.002, 0.1, 0.0005, 0.6))
    periods = int(steady["period"])
    assert periods > 0
    assert steady["contacts"] > 0
    p, scales = packed(machine, damper, frequency), machine.scales
    units = [scales.to_si(1.0, each) for each in ("displacement", "velocity")] * 2
    found = measured_costs(p, steady["state"].values / units, strobe_time(p), periods)
    time = periods / frequency
    y, force, acceleration = by_scipy(machine, damper, frequency, steady["state"].values, time)
    np.testing.assert_allclose(y[:4], steady["state"], rtol=0, atol=1e-8)
    assert scales.unit("power") * found["impact_power"] == pytest.approx(y[4] / time, rel=1e-6)
    assert scales.unit("force") * found["contact_force"] == pytest.approx(force, rel=1e-5)
    largest = scales.unit("acceleration") * found["largest_acceleration"]
    assert largest == pytest.approx(acceleration, rel=1e-5)
    rate = float(steady["contacts"]) * frequency
    assert scales.unit("rate") * found["impact_rate"] == pytest.approx(rate, rel=1e-12)


def test_the_phase_of_the_first_state_does_not_matter(impacting_orbit):
    """If the first state lies in a contact, this contact is counted once, as a whole."""
    p, begin = impacting_orbit.parameters, impacting_orbit.strobe
    expected = measured_costs(p, impacting_orbit.state, begin, 1)
    end = begin + 2 * np.pi / p[FREQUENCY]
    _, log = sample(p, impacting_orbit.state, begin, [end])
    for share in (0.1, 0.6):
        time = log[0, 1] + share * (log[0, 2] - log[0, 1])
        states, _ = sample(p, impacting_orbit.state, begin, [time])
        found = measured_costs(p, states[0], time, 1)
        for name, value in expected.items():
            assert found[name] == pytest.approx(value, rel=1e-8, nan_ok=True), name


def test_a_loose_mass_that_touches_nothing_costs_nothing():
    p = packed(LINEAR, damper_of(LINEAR, gap=0.5), 20.5)
    found = measured_costs(p, np.zeros(4), strobe_time(p), 20)
    for name in ("impact_rate", "impact_speed", "contact_force", "penetration", "impact_power"):
        assert found[name] == 0, name


def test_a_motion_that_escapes_has_no_costs():
    soft = idm.Machine(**SPRING, cubic_stiffness=-4e9, force=40)
    p = packed(soft, damper_of(soft), 20.5)
    barrier = soft.scales.from_si(math.sqrt(2e5 / 4e9), "displacement")
    found = measured_costs(p, np.array([1.1 * barrier, 1.0, 0, 0]), strobe_time(p), 5)
    assert np.isnan(found["impact_rate"]) and np.isnan(found["contact_force"])


def test_pressure_is_that_of_hertz():
    damper = damper_of(LINEAR)
    impact = HERTZ.impact(0.3, 12 * 0.6 / 12.6)
    pressure, yields = pressure_costs(LINEAR, damper, HERTZ, 0.3)
    assert pressure == pytest.approx(HERTZ.pressure(impact.force)) and yields == "yes"
    assert pressure_costs(LINEAR, damper, HERTZ, 0.0) == (0, "no")
    assert pressure_costs(LINEAR, damper, None, 0.3)[1] == "unknown"
