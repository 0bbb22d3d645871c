"""Costs of motions compared with SciPy in SI units, conservation laws, and Hertz's formulas."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from helpers.si_motions import SiMotion

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.design import panels
from impact_damper.design.costs import measured_costs, motion_costs
from impact_damper.design.panels import logged
from impact_damper.model.packed import INVERSE_MASS_RATIO, pack
from impact_damper.motions.simulate import COMPONENTS, simulate
from impact_damper.motions.strobe_map import strobe_time

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005}
LINEAR = idm.Machine(**SPRING, force=40)
HARD = idm.Machine(**SPRING, cubic_stiffness=4e9, unbalance=0.003)
HERTZ = idm.HertzContact("2 cm", "210 GPa", 0.3, "400 MPa")


def damper_of(machine, **others):
    given = {"mass": 0.6, "gap": 0.008, "restitution": 0.7, "contact_stiffness": 2e7} | others
    return machine.damper(**given)


def by_scipy(machine, damper, frequency, state, time):
    """Return the last values of the equations of `SiMotion`, and largest force and acceleration.

    The values are the state, then the works and the impulse that `SiMotion` integrates.
    """
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
    found = motion_costs(machine, damper, frequency, steady["state"].values, periods)
    time = periods / frequency
    y, force, acceleration = by_scipy(machine, damper, frequency, steady["state"].values, time)
    np.testing.assert_allclose(y[:4], steady["state"], rtol=0, atol=1e-8)
    assert float(found["costs_time"]) == pytest.approx(time, rel=1e-12)
    for name, work in zip(("force_power", "dashpot_power", "impact_power"), y[4:], strict=False):
        assert float(found[name]) == pytest.approx(work / time, rel=1e-6), name
    assert float(found["contact_impulse"].sum()) == pytest.approx(y[7], rel=1e-6)
    assert float(found["contact_loss"].sum()) == pytest.approx(y[6], rel=1e-6)
    assert float(found["contact_force"]) == pytest.approx(force, rel=1e-5)
    assert float(found["largest_acceleration"]) == pytest.approx(acceleration, rel=1e-5)
    count = float(steady["contacts"]) * frequency
    assert float(found["impact_rate"]) == pytest.approx(count, rel=1e-12)
    noise = np.sum(found["contact_impulse"].values ** 2) / time
    assert float(found["impulse_noise"]) == pytest.approx(noise, rel=1e-12)
    assert found["costs_status"] == flag("costs_status", "impacts")


def test_an_impulse_is_the_change_of_momentum_and_powers_balance(impacting_orbit):
    p = impacting_orbit.parameters
    found = measured_costs(p, impacting_orbit.state, impacting_orbit.strobe, 1)
    assert abs(found["power_error"]) < 1e-11
    assert abs(found["stored_power"]) < 1e-9
    moments = np.column_stack([found["contact_begin"], found["contact_end"]]).ravel()
    states, _ = logged(p, impacting_orbit.state, impacting_orbit.strobe, moments)
    loose = (states[:, 1] - states[:, 3]).reshape(-1, 2)
    change = found["contact_wall"] * np.diff(loose)[:, 0] / p[INVERSE_MASS_RATIO]
    np.testing.assert_allclose(found["contact_impulse"], change, rtol=1e-11)


def test_powers_balance_in_chaos():
    """In a motion that does not repeat, the work that is not lost is stored as energy."""
    p = pack(PAPER, DESIGN, 1.9)
    found = measured_costs(p, np.array([1.0, 0.5, -0.3, 2.0]), strobe_time(p), 200)
    assert found["costs_status"] == flag("costs_status", "impacts")
    assert abs(found["stored_power"]) > 1e-6
    assert abs(found["power_error"]) < 1e-10
    assert len(found["contact_loss"]) > 300


def test_the_phase_of_the_first_state_does_not_matter():
    """If the first state lies in a contact, this contact is counted once, as a whole."""
    damper = damper_of(LINEAR)
    steady = idm.steady_motion(LINEAR, damper, 20.5)
    expected = motion_costs(LINEAR, damper, 20.5, steady["state"].values, int(steady["period"]))
    start = 0.25 / 20.5
    run = simulate(
        LINEAR, damper, 20.5, steady["state"].values, periods=1, samples=1000, start=start
    )
    touching = np.flatnonzero(np.abs(run["relative_displacement"]) > 4)
    assert len(touching) > 10
    for sample in touching[[1, len(touching) // 2]]:
        state = [float(run[name][sample]) for name in COMPONENTS] * np.array([1e-3, 1, 1e-3, 1])
        time = float(run["time"][sample])
        found = motion_costs(
            LINEAR, damper, 20.5, state, int(steady["period"]), start=time
        ).drop_vars(("power_error", "stored_power"))
        for name, each in found.items():
            if each.dims == () and np.isfinite(each):
                assert float(each) == pytest.approx(float(expected[name]), rel=1e-8), name


def test_a_loose_mass_that_touches_nothing_costs_nothing():
    damper = damper_of(LINEAR, gap=0.5)
    found = motion_costs(LINEAR, damper, 20.5, [0, 0, 0, 0], 20, contact=HERTZ)
    assert found["costs_status"] == flag("costs_status", "no_impact")
    for name in ("impact_rate", "impact_speed", "contact_force", "penetration", "impact_power"):
        assert found[name] == 0, name
    assert found["contact_pressure"] == 0
    assert found["contact_yields"] == flag("contact_yields", "no")
    assert np.isnan(found["mean_impact_speed"])
    assert abs(found["power_error"]) < 1e-10


def test_a_motion_that_escapes_says_so():
    soft = idm.Machine(**SPRING, cubic_stiffness=-4e9, force=40)
    barrier = math.sqrt(2e5 / 4e9)
    damper = damper_of(soft)
    found = motion_costs(soft, damper, 20.5, [1.1 * barrier, 1.0, 0, 0], 5)
    assert found["costs_status"] == flag("costs_status", "escaped")
    assert np.isnan(found["impact_rate"])
    assert np.isnan(found["contact_force"])


def test_pressure_is_that_of_the_fastest_impact():
    damper = damper_of(LINEAR)
    steady = idm.steady_motion(LINEAR, damper, 20.5)
    found = motion_costs(LINEAR, damper, 20.5, steady["state"].values, 1, contact=HERTZ)
    speed = np.abs(found["approach_velocity"]).max()
    assert float(found["impact_speed"]) == pytest.approx(float(speed), rel=1e-14)
    impact = HERTZ.impact(float(speed), 12 * 0.6 / 12.6)
    assert float(found["hertz_force"]) == pytest.approx(impact.force, rel=1e-12)
    assert float(found["contact_pressure"]) == pytest.approx(HERTZ.pressure(impact.force))
    assert found["contact_yields"] == flag("contact_yields", "yes")
    without = motion_costs(LINEAR, damper, 20.5, steady["state"].values, 1)
    assert np.isnan(without["contact_pressure"])
    assert without["contact_yields"] == flag("contact_yields", "unknown")


@pytest.mark.parametrize(
    ("wrong", "told"),
    [
        ({"machine": PAPER}, "machine = Oscillator("),
        ({"contact": 2e7}, "contact = 20000000.0"),
        ({"periods": 0}, "periods = 0: must be from 1 to 10000"),
        ({"damper": None}, "damper = None: must be a MachineDamper"),
        ({"frequency": -1}, "frequency = -1 Hz: must be at least"),
        ({"state": [0, 0]}, "state = "),
    ],
)
def test_wrong_arguments_are_told(wrong, told):
    given = {"machine": LINEAR, "damper": damper_of(LINEAR), "frequency": 20.5}
    given |= {"state": [0, 0, 0, 0], "periods": 1}
    with pytest.raises((TypeError, ValueError)) as raised:
        motion_costs(**given | wrong)
    assert str(raised.value).startswith(told)


@pytest.mark.parametrize("frequency", [1.0, 3.0])
def test_integrals_and_largest_values_of_panels_are_exact(frequency):
    lengths = np.array([0.9, 0.6, 1.1])
    begins = np.array([0.0, 0.9, 1.5])
    times = begins[:, None] + lengths[:, None] * (panels.NODES + 1) / 2
    made = panels.Panels(None, lengths, times, None, None, None)
    values = np.cos(frequency * times - 0.4) + 0.1 * times
    closed = (np.sin(2.6 * frequency - 0.4) + np.sin(0.4)) / frequency + 0.05 * 2.6**2
    assert np.sum(panels.integrals(made, values)) == pytest.approx(closed, rel=1e-8)
    moments = np.linspace(0, 2.6, 10**6)
    dense = np.max(np.abs(np.cos(frequency * moments - 0.4) + 0.1 * moments))
    assert panels.largest(values) == pytest.approx(dense, rel=1e-9)
