"""Gravity, friction and walls that never pull: closed forms, laws, another integrator."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from references import equation
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import impact_damper as idm
from impact_damper.kernel.single import side_of, step, workspace
from impact_damper.kernel.tangents import advance
from impact_damper.model import packed
from impact_damper.model.packed import pack

# FREE: a primary mass without spring, with a force of the amplitude 1. STILL: at rest on a spring.
FREE = idm.Oscillator(1e-9, cubic=0.0)
STILL = idm.Oscillator(1.0, 1.0, cubic=0.0, force=0.0)
NAMES = "displacement velocity relative_displacement relative_velocity".split()
RATIO, WIDE, BENT = 0.2, 100.0, {"linear_frequency": 1.0, "cubic": 0.5}


@pytest.mark.parametrize("rule", ["no_tension", "zero_penetration"])
@pytest.mark.parametrize("restitution", [0.05, 0.13, 0.14, 0.5, 0.9, 1.0])
def test_the_restitution_is_the_one_asked_for(restitution, rule):
    damper = idm.Damper(RATIO, 1.0, restitution, 1e4, exit_rule=rule)
    free = idm.Oscillator(1e-9, cubic=0.0, force=0.0)
    found = idm.simulate(free, damper, 1.0, (0, 0, 0, 1.0), periods=0.3)
    ratio = -found.departure_velocity[0] / found.approach_velocity[0]
    assert float(ratio) == pytest.approx(restitution, rel=1e-9)


def test_a_wall_that_never_pulls_only_pushes():
    """The force k q + c q' that follows from the samples of a contact falls to 0 at its end."""
    damper = idm.Damper(RATIO, 1.0, 0.3, 100.0, exit_rule="no_tension")
    found = idm.simulate(FREE, damper, 1.0, (0, 0, 0.99, 1.0), periods=0.1, samples=20000)
    end = float(found.contact_end[0])
    depth, rate = found.relative_displacement - 1.0, found.relative_velocity
    force = damper.contact_stiffness * depth + damper.dashpot * rate
    assert np.all(force[(depth > 0) & (found.time < end)] > 0)
    assert abs(float(force.interp(time=end))) < 1e-4
    assert float(depth.interp(time=end)) > 1e-3


@pytest.mark.parametrize("share", [0.99, 1.5])
def test_a_block_on_a_shaken_table(share):
    """The block sticks at accelerations up to f. Above f it slides, sticks, and slides back.

    Sticking, both bodies accelerate by cos(W T)/(1 + rm). Sliding, Z2'' = cos(W T) - (1 + rm) f.
    """
    friction = 1 / (1 + RATIO) / share
    damper = idm.Damper(RATIO, WIDE, friction=friction)
    found = idm.simulate(FREE, damper, 1.0, start=0.0, periods=1, samples=100)
    t, z = found.time.values, found.relative_displacement.values
    if share < 1:
        assert_allclose(found.displacement, (1 - np.cos(t)) / (1 + RATIO), atol=1e-7)
        assert np.all(z == 0)
        return
    stop = brentq(lambda t: math.sin(t) - t / share, 0.1, 3)
    slides = t < stop
    assert_allclose(z[slides], (1 - np.cos(t) - t**2 / 2 / share)[slides], atol=1e-7)
    height, slip = 1 - math.cos(stop) - stop**2 / 2 / share, math.acos(-1 / share)
    sticks = (t > stop) & (t < slip)
    assert_allclose(z[sticks], height, atol=1e-7)
    back = (t > slip) & (t < slip + 1)
    since = t[back] - slip
    fallen = np.cos(slip) - np.cos(t[back]) - since * math.sin(slip) + since**2 / 2 / share
    assert_allclose(z[back], height + fallen, atol=1e-7)


def test_friction_stops_a_sliding_mass():
    """The distance is v^2/(2 (1 + rm) f). The energy lost is rm f times the distance."""
    free = idm.Oscillator(1e-9, cubic=0.0, force=0.0)
    damper = idm.Damper(RATIO, WIDE, friction=0.3)
    found = idm.simulate(free, damper, 1.0, (0, 0, 0, 2.0), periods=2)
    path = 2.0**2 / (2 * (1 + RATIO) * 0.3)
    assert found.relative_displacement[-1] == pytest.approx(path, rel=1e-7)
    assert found.relative_velocity[-1] == 0
    lost = RATIO / 2 * 2.0**2 - (1 + RATIO) / 2 * found.velocity[-1] ** 2
    assert lost == pytest.approx(RATIO * 0.3 * path, rel=1e-7)


def test_what_goes_in_is_lost_or_stored():
    """Stored energy = work of force, base and gravity - losses by dashpot and friction."""
    oscillator = idm.Oscillator(0.215, **BENT, force=2.0, base=0.7)
    damper = idm.Damper(RATIO, 0.8, gravity=0.3, friction=0.4)
    found = idm.simulate(oscillator, damper, 2.0, (0.1, 0, 0.3, 0.4), periods=6, samples=8000)
    x, v, z, w = (found[name].values for name in NAMES)
    drive = 2.0 * np.cos(2.0 * found.time.values)
    depth = np.maximum(np.abs(z) - 0.8, 0)
    stored = v**2 / 2 + x**2 / 2 + 0.5 * x**4 / 4 + RATIO * (v - w) ** 2 / 2
    stored += damper.contact_stiffness * depth**2 / 2
    power = drive * v + RATIO * (oscillator.base * drive - 0.3) * (v - w)
    power -= 0.215 * v**2 + RATIO * 0.4 * np.abs(w)
    work = np.trapezoid(power, found.time.values)
    assert found.sizes["contact"] > 5
    assert stored[-1] - stored[0] == pytest.approx(work, abs=2e-5)


def test_a_bouncing_mass_comes_to_rest_on_the_wall():
    """Heights fall by the factor e^2. At rest both the wall and the spring carry the weight."""
    ratio, gravity, restitution = 1e-4, 1.0, 0.6
    damper = idm.Damper(ratio, 1.0, restitution, 1e3, gravity=gravity, exit_rule="no_tension")
    found = idm.simulate(STILL, damper, 1.0, (0, 0, 0.5, 0), start=0.0, periods=6)
    speeds = found.departure_velocity.values[:5]
    expected = math.sqrt(2 * gravity * 0.5) * restitution ** np.arange(1, 6)
    assert_allclose(-speeds, expected, rtol=5e-3)
    at_rest = [-ratio * gravity, 0, 1 + ratio * gravity / 1e3, 0]
    assert_allclose([float(found[name][-1]) for name in NAMES], at_rest, atol=1e-8)


def by_events(p, y, end):
    """Return the state at the time `end`, by SciPy with events for contacts, stops and slips."""
    t, y, wall, slide = 0.0, np.array(y), 0, int(np.sign(y[3]))
    limit, inverse, d = p[packed.FRICTION], p[packed.INVERSE_MASS_RATIO], p[packed.CLEARANCE]

    def needed(t, y, wall):
        """Return the acceleration that friction must give to a mass that sticks."""
        free = equation.rates(p, wall, 1)(t, [*y[:3], 0.0])
        return (free[3] + (1 + 1 / inverse) * limit) / (1 + 1 / inverse)

    def halt(t, y):
        return y[3] if slide else limit - abs(needed(t, y, wall))

    def meet(t, y):
        return d - abs(y[2]) if not wall else wall * (y[2] + p[packed.LAG] * y[3]) - d

    halt.terminal = meet.terminal = True
    while t < end:
        meet.direction = -1
        halt.direction = -slide or -1
        events = [halt, meet] if slide or not wall else [halt]
        rate = equation.rates(p, wall, slide)
        tight = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13, "max_step": 0.01}
        tight["first_step"] = min(1e-6, end - t)
        run = solve_ivp(rate, (t, end), y, events=events, **tight)
        t, y = run.t[-1], run.y[:, -1].copy()
        if run.status == 0:
            break
        if len(run.t_events[0]):
            more = needed(t, y, wall)
            slides = slide == 0 or abs(more) > limit
            slide = int(np.sign(more)) if slides else 0
            y[3] = 1e-13 * slide
        elif wall:
            wall = 0
        else:
            wall = int(np.sign(y[2]))
            y[2] = wall * d
    return y


ROUGH = [
    ({"friction": 0.2}, {}),
    ({"friction": 0.8}, {}),
    ({"friction": 0.3, "gravity": 0.4}, BENT | {"base": 1.0}),
    ({"friction": 0.7, "gravity": 0.9, "restitution": 0.3}, BENT | {"force": 2.0}),
]


@pytest.mark.parametrize(("of_damper", "of_oscillator"), ROUGH)
def test_sliding_and_sticking_by_another_integrator(of_damper, of_oscillator):
    oscillator = idm.Oscillator(0.215, **of_oscillator)
    damper = idm.Damper(0.12, 0.8, **{"restitution": 0.6} | of_damper)
    state = (0.1, 0.0, 0.3, 0.4)
    found = idm.simulate(oscillator, damper, 2.0, state, start=0.0, periods=4)
    expected = by_events(pack(oscillator, damper, 2.0), state, 4 * math.pi)
    last = [float(found[name][-1]) for name in NAMES]
    assert_allclose(last, expected, atol=1e-7)


@pytest.mark.parametrize("rule", ["no_tension", "zero_penetration"])
@pytest.mark.parametrize(("of_damper", "of_oscillator"), ROUGH)
def test_tangents_are_difference_quotients(of_damper, of_oscillator, rule):
    oscillator = idm.Oscillator(0.215, **of_oscillator)
    damper = idm.Damper(0.12, 0.8, **{"restitution": 0.6, "exit_rule": rule} | of_damper)
    p, start, end = pack(oscillator, damper, 2.0), np.array([0.1, 0.0, 0.3, 0.4]), 3.3

    def moved(y, tangents):
        advance(p, y, tangents, side_of(p, start), 0.0, end, 1e-13, workspace())
        return y

    tangents = np.eye(4)
    moved(start.copy(), tangents)
    step = 1e-6 * np.eye(4)
    ends = [[moved(start + s * d, np.empty((0, 4))) for s in (1, -1)] for d in step]
    quotients = [(ahead - behind) / 2e-6 for ahead, behind in ends]
    assert_allclose(tangents, quotients, atol=1e-5 * max(1, np.abs(quotients).max()))


def test_a_flight_moves_on_from_a_separation_behind_the_wall():
    """The error of the separation exceeds the rounding errors of the flight after it."""
    p = np.array([
        0.9975092120424324, 0.019950184240848642, 0.9950246281095139, 0.0049753718904860045,
        0.0, 0.1414178209243579, 1.0, 0.21212673138653673, 4.975123140547569, 10.0,
        0.24326186655003557, 0.04889564733934642, 0.0, 0.0
    ])  # fmt: skip
    y = np.array([
        0.062449098144035854, -1.779071228651208, -0.1699886135892479, 7.288015869970868
    ])  # fmt: skip
    work, side, t, steps = workspace(), side_of(p, y), 0.0, 0
    while t < 2 * math.pi / p[0] and steps < 1000:
        length, side = step(p, y, side, t, 6.0, 1e-9, work)
        t, steps = t + length, steps + 1
    assert steps < 200
