"""Each field of `Oscillator` has an effect or is refused, wherever its term matters."""

import re
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from helpers.sampling import flow_map, sample
from numpy.testing import assert_allclose
from references import equation, extended
from references.equation import SPRINGS

import impact_damper as idm
from chatterjee1995.methods.equations import rate
from chatterjee1995.methods.many_harmonics import Balance
from chatterjee1995.methods.quiet_orbits import straight_flight_end
from impact_damper.kernel import batch
from impact_damper.kernel import equation as kernel
from impact_damper.model.families import FORCING
from impact_damper.model.packed import cubic_spring, pack
from impact_damper.model.parameters import (
    NONLINEAR,
    SPRING_POWER,
    Damper,
    Oscillator,
    parameters_in,
)
from impact_damper.motions.start_states import barrier
from impact_damper.theory.design_rule import peak_frequency, rule_clearance
from impact_damper.theory.free_oscillator import (
    free_folds,
    free_solutions,
    main_solutions,
    maximum_response,
    resonance,
)
from impact_damper.theory.single_harmonic import (
    impacting_solutions,
    jacobian,
    resting_solutions,
    rigid_solutions,
)
from impact_damper.theory.straight_flight import flight_of

ROOT = Path(__file__).parents[3]
PARAMETERS = [each.name for each in parameters_in(Oscillator)]
# Fields of the oscillator that act on the loose mass alone.
LOOSE = ["base"]
ALONE = [name for name in PARAMETERS if name not in LOOSE]
SPRING = {"linear_frequency", *NONLINEAR}
BENT = Oscillator(0.1, 1.0, cubic=0.5, force=0.6, unbalance=0.02)
LINEAR = Oscillator(0.1, 1.0, cubic=0.0, force=0.6, unbalance=0.02)
SOFT = Oscillator(0.1, 1.0, cubic=-0.2, force=0.03)
DAMPER = Damper(0.15, 0.6, 0.8, 900.0)
ACROSS = {name: {name: 0.1} for name in ("gravity", "friction")}
ELASTIC = replace(DAMPER, restitution=1.0)
WIDE = replace(ELASTIC, clearance=50.0)
W = 1.3
STATE = np.array([0.35, 0.8, 0.1, -0.4])
Z1 = np.linspace(-1.5, 1.5, 7)
every_parameter = pytest.mark.parametrize("name", PARAMETERS)


def changed(oscillator, name):
    """Return the oscillator with another value of a field."""
    value = getattr(oscillator, name)
    return replace(oscillator, **{name: 1.25 * value if value else 0.1})


def pairs(name, bases=(BENT, LINEAR)):
    """Return pairs of oscillators that differ in one field, for all bases that allow the field."""
    found = []
    for base in bases:
        try:
            found.append((base, changed(base, name)))
        except ValueError as refusal:
            assert re.match(r"\w+ = .*: must be", str(refusal))
    return found


def packed(oscillator, damper=None):
    return pack(oscillator, damper, W)


def several(oscillator):
    states = np.tile(STATE, (20, 1))
    arguments = np.zeros(20, int), np.zeros(20), np.full(20, 3.0), 1e-12, np.zeros(20, int)
    batch.advance(np.tile(packed(oscillator, DAMPER), (20, 1)), states, *arguments)
    return states


def reference_80_bit(oscillator):
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    return extended.run(packed(oscillator, DAMPER), STATE, 0.0, [3.0]).states


def tangents_80_bit(oscillator):
    if extended.obstacle():
        pytest.skip(extended.obstacle())
    return extended.run(packed(oscillator), np.tile(STATE[:2], 2), 0.0, [1.0]).flow[:2, :2]


# File of the package -> functions of an oscillator. A change of any field must change the result of
# each function.
PLACES = {
    "model/packed.py": [packed],
    "kernel/equation.py": [
        lambda oscillator: sample(packed(oscillator, DAMPER), STATE, 0.0, [3.0])[0],
        several,
    ],
    "theory/single_harmonic.py": [
        lambda oscillator: np.hstack(impacting_solutions(oscillator, ELASTIC, W)),
        lambda oscillator: resting_solutions(oscillator, WIDE, W).amplitude,
        lambda oscillator: np.hstack(rigid_solutions(oscillator, ELASTIC, W)),
    ],
    "tests/references/equation.py": [
        lambda oscillator: equation.rates(packed(oscillator, DAMPER))(0.4, STATE)
    ],
    "tests/references/extended/motion.c": [reference_80_bit],
}
# Functions of the primary mass alone, and functions of the paper's methods.
ALONE_PLACES = {
    "kernel/equation.py": [
        lambda oscillator: kernel.acceleration(packed(oscillator), STATE, 0.4),
        lambda oscillator: rate(packed(oscillator), 0, 0.4, tuple(STATE)),
    ],
    "theory/free_oscillator.py": [
        lambda oscillator: free_solutions(oscillator, W).amplitude,
        lambda oscillator: main_solutions(oscillator, W).amplitude,
        lambda oscillator: resonance(oscillator, W).amplitude,
        maximum_response,
    ],
}
# SPRING_PLACES must change with every field of the spring, NONLINEAR_PLACES with nonlinear fields.
SPRING_PLACES = {
    "kernel/equation.py": [
        lambda oscillator: kernel.energy.py_func(packed(oscillator), STATE),
        lambda oscillator: kernel.spring_slope.py_func(packed(oscillator), 0.7),
        lambda oscillator: flow_map(
            packed(oscillator), np.tile(STATE[:2], 2), 0.0, 1, False, 1e-13
        ),
    ],
    "theory/single_harmonic.py": [lambda oscillator: jacobian(STATE, oscillator, DAMPER, W)],
    "tests/references/extended/motion.c": [tangents_80_bit],
}
NONLINEAR_PLACES = {
    "model/packed.py": [lambda oscillator: cubic_spring(packed(oscillator))],
    "model/parameters.py": [lambda oscillator: oscillator.hardening],
}
# Functions whose results must change with every field that is allowed with a nonlinear spring.
BENT_PLACES = {
    "theory/free_oscillator.py": [lambda oscillator: np.array(free_folds(oscillator))],
    "theory/design_rule.py": [peak_frequency, partial(rule_clearance, mass_ratio=0.1)],
}
# Files that need a spring force that is odd in Z1.
SYMMETRIC = "methods/many_harmonics.py, methods/quiet_orbits.py, orbits/shooting.py"


def flat(result):
    """Return all numbers of a result as one array."""
    if isinstance(result, tuple) and not hasattr(result, "_fields"):
        return np.concatenate([flat(part) for part in result])
    return np.ravel(np.asarray(result, float))


# Table of functions by file, fields that must change the results, oscillators that are changed.
TABLES = [
    (PLACES, PARAMETERS, (BENT, LINEAR)),
    (ALONE_PLACES, ALONE, (BENT, LINEAR)),
    (SPRING_PLACES, sorted(SPRING), (BENT, LINEAR)),
    (BENT_PLACES, ALONE, (BENT,)),
    (NONLINEAR_PLACES, NONLINEAR, (BENT,)),
]


@pytest.mark.parametrize(
    ("file", "function", "name", "bases"),
    [
        pytest.param(file, function, name, bases, id=f"{file}-{number}-{name}")
        for places, names, bases in TABLES
        for file, functions in places.items()
        for number, function in enumerate(functions)
        for name in names
    ],
)
def test_every_parameter_has_an_effect_or_is_refused(file, function, name, bases):
    for one, other in pairs(name, bases):
        before = flat(function(one))
        try:
            after = flat(function(other))
        except ValueError as refusal:
            assert re.match(rf"{name} = ", str(refusal)), f"{file}: {refusal}"
            continue
        closed = ", in `hardening` of model/parameters.py" if file.startswith("theory/") else ""
        assert not np.array_equal(before, after), (
            f"{file}: nothing changes with {name} = {getattr(other, name):g}. Add its term, or "
            f'raise ValueError("{name} = ...: must be 0 ..."){closed}'
        )


def refused(function, name):
    """Return whether a function raises a ValueError that begins with a name."""
    try:
        function()
    except ValueError as refusal:
        return str(refusal).startswith(f"{name} = ")
    return False


@pytest.mark.parametrize("name", [*LOOSE, *ACROSS])
def test_what_acts_on_the_loose_mass_has_an_effect_with_a_damper_alone(name):
    """Gravity, friction and a moving base change motions, or are refused by their name."""
    base, damper = replace(BENT, base=float(name in LOOSE)), replace(DAMPER, **ACROSS.get(name, {}))
    alone = [idm.simulate(each, None, W, STATE[:2], periods=3) for each in (BENT, base)]
    assert np.array_equal(*[each.displacement for each in alone])
    before = idm.simulate(BENT, DAMPER, W, STATE, periods=3)
    after = idm.simulate(base, damper, W, STATE, periods=3)
    assert abs(after.displacement[-1] - before.displacement[-1]) > 1e-3
    damper = replace(damper, restitution=1.0)
    assert refused(lambda: idm.harmonic_balance(base, damper, [W]), name)
    sweep = partial(idm.clearance_sweep, base, damper, W, [0.5, 0.6], method="harmonic_balance")
    assert refused(sweep, name)
    for function in (impacting_solutions, rigid_solutions, flight_of, partial(Balance, highest=3)):
        assert refused(partial(function, base, damper, frequency=W), name)


@every_parameter
def test_parameters_are_named_by_their_kind(name):
    """NONLINEAR and FORCING, over which other modules loop, are complete."""
    for one, other in pairs(name):
        p, q = packed(one), packed(other)
        slopes = kernel.spring_slope.py_func(q, Z1) - kernel.spring_slope.py_func(p, Z1)
        assert np.any(slopes != slopes[0]) == (name in NONLINEAR), (
            f"model/parameters.py: NONLINEAR must have {name} if it is a nonlinear term of the "
            "spring, and only then"
        )
        forced = kernel.forcing_amplitude.py_func(p) != kernel.forcing_amplitude.py_func(q)
        assert forced == (name in FORCING), (
            f"model/families.py: FORCING must have {name} if it is a part of the forcing "
            "amplitude, and only then"
        )
        assert forced == (one.forcing_amplitude(W) != other.forcing_amplitude(W)), (
            f"model/parameters.py: forcing_amplitude must have {name}, as in kernel/equation.py"
        )
        if forced:
            ends = [straight_flight_end(each, 2.0, 0.5) for each in (one, other)]
            assert ends[0] != ends[1], f"methods/quiet_orbits.py: straight_flight_end lacks {name}"
        elif name not in NONLINEAR and name not in LOOSE:
            flights = [np.hstack(flight_of(each, DAMPER, W)) for each in (one, other)]
            assert np.any(flights[0] != flights[1]), f"theory/straight_flight.py lacks {name}"


@every_parameter
def test_damping_is_the_only_term_in_the_velocity(name):
    """Closed forms, balances and variations contain the term h Z1' and no further term in Z1'."""
    for _, other in pairs(name):
        p, still = packed(other), STATE * (1, 0, 1, 1)
        drag = kernel.acceleration(p, still, 0.4) - kernel.acceleration(p, STATE, 0.4)
        assert_allclose(drag, other.damping * STATE[1], rtol=1e-12)


@every_parameter
def test_the_spring_is_odd(name):
    """With an even term no motion is symmetric. Modules for symmetric motions must refuse it."""
    for _, other in pairs(name):
        force = kernel.spring.py_func(packed(other), Z1)
        assert np.array_equal(force, -force[::-1]), (
            f"{name} is not odd in Z1, so motions are not symmetric: refuse it in {SYMMETRIC}"
        )


@every_parameter
def test_a_spring_that_pushes_outward_is_said_to_soften(name):
    for _, other in pairs(name, (BENT, LINEAR, SOFT)):
        p, far = packed(other), 1e3 * np.arange(1.0, 4.0)
        softens = bool(np.any(kernel.spring.py_func(p, far) < 0))
        assert other.softens == softens, "model/parameters.py: softens"
        assert np.isfinite(kernel.no_return(p)) == softens, "kernel/equation.py: no_return"
        if softens:
            edge, _ = barrier(other)
            pushes = kernel.spring.py_func(p, edge * np.array([1 - 1e-9, 1 + 1e-9]))
            assert pushes[0] > 0 > pushes[1], "motions/start_states.py: barrier"


@pytest.mark.parametrize("name", SPRINGS)
def test_equations_of_the_package_are_those_of_the_reference(name):
    """They are force, slope and energy of the spring, and the harmonics of the spring's force."""
    oscillator = SPRINGS[name]
    p = packed(oscillator)
    same = partial(assert_allclose, rtol=1e-10, atol=1e-12)
    same(kernel.spring.py_func(p, Z1), equation.spring(p, Z1), err_msg="kernel/equation.py: spring")
    same(
        kernel.spring_slope.py_func(p, Z1),
        equation.slope(p, Z1),
        err_msg="kernel/equation.py: spring_slope",
    )
    stored = [kernel.energy.py_func(p, [x, 0.0, 0.0, 0.0]) for x in Z1]
    same(stored, equation.potential(p, Z1), err_msg="kernel/equation.py: energy")
    many = Balance(oscillator, None, W, 5)
    series = np.array([[0.4 - 0.2j, 0.1 + 0.05j, -0.03j]])
    angle = 2 * np.pi * np.arange(256) / 256
    turning = 2 * series[0] * np.exp(1j * np.outer(angle, many.harmonics))
    x, v, a = (np.sum(turning * many.rates**power, axis=1).real for power in range(3))
    left = np.fft.rfft(a - equation.flight(p, x, v, np.cos(angle)))[many.harmonics] / len(angle)
    words = f"model/parameters.py: SPRING_POWER = {SPRING_POWER}"
    same(many.residual(series, np.empty((0, 3)))[0], left, err_msg=words)


@every_parameter
def test_every_parameter_is_in_the_systems_of_the_tests_and_the_manual(name):
    usual = Oscillator(0.1)
    assert any(getattr(each, name) != getattr(usual, name) for each in SPRINGS.values()), (
        f"tests/references/equation.py: SPRINGS need an oscillator with {name}"
    )
    symbols = (ROOT / "docs/index.md").read_text()
    assert f"`{name}`" in symbols, f"docs/index.md: the table of symbols lacks {name}"
