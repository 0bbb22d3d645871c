"""A wrong argument of a public function raises at once."""

import inspect
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import impact_damper as idm

OSCILLATOR = idm.Oscillator(0.215)
DAMPER = idm.Damper(0.12, 2.0)
STATE = (0.006, 0.187, 0.002, -2.408)

no_numbers = st.sampled_from([None, "2", "", b"2", True, 1j, [2.0], {}, {1}, np.array([1.0, 2.0])])
not_finite = st.sampled_from([math.nan, math.inf, -math.inf, np.float32("nan"), 10**400])
negative = st.floats(-1e300, -1e-300) | st.integers(-(10**30), -1)
huge = st.floats(1e10, 1e300) | st.integers(10**10, 10**40)
no_counts = no_numbers | not_finite | negative | st.sampled_from([0.5, 2.0, 10**19])
count = no_counts | st.just(0)
positive = no_numbers | not_finite | negative | huge | st.sampled_from([0, 0.0, -0.0])
no_sequences = st.sampled_from(
    [None, "12", {}, 1j, ["1", "2"], [[1.0], [2.0]], [[1.0], [2.0, 3.0]], [True, 2], [None]]
)
no_increase = st.sampled_from([[], [2.0, 1.0], [1.0, 1.0], [1, 2, 2], np.array([3.0, 2.0])])
bad_items = st.sampled_from([[math.nan, 1.0], [1.0, math.inf], [0.0, 1.0], [-1, 1], [1.0, 1e300]])
increasing = no_sequences | no_increase | bad_items
state = st.sampled_from(
    [None, "1234", 1.0, (1, 2, 3), (1, 2, 3, 4, 5), ("1", 0, 0, 0), (math.nan, 0, 0, 0)]
    + [(0, 0, 0, math.inf), np.zeros((2, 2)), (1e9, 0, 0, 0), (0, 1e9, 0, 0), (True, 0, 0, 0), {}]
)
no_si = no_numbers.filter(lambda value: value is not None)
no_start = no_si | not_finite | huge
si = no_si | not_finite | negative
MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
no_oscillator = st.sampled_from([None, 0.215, "h215", {}, DAMPER, idm.Oscillator])
no_damper = st.sampled_from([0.12, "rm", {}, (0.12, 2.0), OSCILLATOR, idm.Damper, False, 0])
no_settling = st.sampled_from([0, 300, "", "long", {}, False, idm.Settling, (1e-9, 300)])
seed = no_numbers | not_finite | negative | st.sampled_from([1.5, 2**64])
span = st.sampled_from(
    [None, 1.0, "12", (1.0,), (1, 2, 3), (2.2, 2.0), (2.5, 2.9), (0, 3), (-1, 3)]
)
span |= st.sampled_from([(math.nan, 3.0), (1.0, math.inf), ("1", "3"), (1.0, 1e9), (1e-9, 3.0)])

# None is allowed as radius: the starts are then scaled by the motions without the damper.
radius = positive.filter(lambda value: value is not None)
# A half width of the plane of `basins` may be two numbers, so an array is not wrong.
no_box = radius.filter(lambda value: not isinstance(value, np.ndarray))
limit = no_si.filter(lambda value: value is not None) | st.just(0)

# Wrong values of arguments that have the same meaning in all functions.
WRONG = {
    "band": st.sampled_from([None, 1.0, "12", (21, 20), (30, 34), ("20 m", 21), (-20, 21)]),
    "cells": count,
    "clearances": increasing | st.just([2.0]),
    "damper": no_damper,
    "displacement": no_box,
    "displacement_limit": limit,
    "effort": st.sampled_from([3, {"starts": 96}, MACHINE]),
    "frequencies": increasing,
    "frequency": positive,
    "longest_hold": count,
    "loose": st.sampled_from([1.0, "12", (1,), (1, 2, 3), (math.nan, 0), ("1", 0)]),
    "machine": no_oscillator,
    "method": st.sampled_from([None, "", "exact", 3, {}, ["simulated"]]),
    "motions": st.sampled_from([3, "motions", [1], [DAMPER], {}]),
    "parameter": st.sampled_from([None, "", "gap", 3, ["frequency"], "tolerance"]),
    "period": count,
    "periods": positive,
    "phase": no_start,
    "radius": radius,
    "samples": count,
    "seed": seed,
    "settling": no_settling,
    "share": no_numbers | not_finite | st.sampled_from([0.1, 1.0]),
    "span": span,
    "start": no_start,
    "starts": count,
    "state": state,
    "switchings": count,
    "system": no_oscillator,
    "tolerance": positive,
    "tolerances": st.sampled_from(
        [0.2, "gap", ["gap"], {"gap": 1.2}, {"gap": -0.1}, {"mass": 0.1}, {"gap": None}]
    ),
    "velocity": no_box,
    "workers": count,
}
GOOD = {"system": OSCILLATOR, "damper": DAMPER}
MOVING = GOOD | {"frequency": 2.0, "state": STATE}
TASK = {"machine": MACHINE, "band": (20, 21)}
REAL = MACHINE.damper(mass=0.6, gap=0.005, restitution=0.7, contact_stiffness=2e7)
OF_DAMPER = ("mass_ratio", "clearance", "restitution", "contact_stiffness")
# Public function -> valid arguments, and wrong values of arguments that only this function has.
FUNCTIONS = {
    "Oscillator": ({"damping": 0.2}, {"damping": positive, "linear_frequency": negative | huge}),
    "Damper": ({"mass_ratio": 0.1, "clearance": 1.0}, dict.fromkeys(OF_DAMPER, positive)),
    "Settling": ({}, {"patience": count, "limit": count, "watched": count, "further": negative}),
    "Machine": (
        {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005, "force": 40},
        {
            "mass": si | st.just(0),
            "linear_stiffness": si | st.just("2e5 N"),
            "cubic_stiffness": no_si | not_finite | st.just("4e9 N/m"),
            "damping_ratio": si | st.sampled_from([0, 1.5]),
            "force": si | st.just("40 kg"),
        },
    ),
    "HertzContact": (
        {"radius": 0.01, "youngs_modulus": 2.1e11, "poissons_ratio": 0.3},
        {"radius": si, "youngs_modulus": si | st.just(0), "poissons_ratio": si | st.just(0.7)},
    ),
    "design_damper": (
        TASK | {"mass": 0.6, "restitution": 0.7, "contact": 2e7},
        {
            "mass": si | st.sampled_from([0, 12.1, "0.6 m"]),
            "restitution": si | st.sampled_from([0, 1.1]),
            "contact": si | st.sampled_from([0, MACHINE, "steel", {}]),
        },
    ),
    "evaluate_damper": (TASK | {"damper": REAL}, {}),
    "Effort": ({}, {"frequencies": count | st.just(2), "candidates": count | st.just(2)}),
    "simulate": (MOVING, {}),
    "steady_motion": (MOVING, {}),
    "frequency_response": (GOOD | {"frequencies": [2.0], "starts": 1}, {}),
    "harmonic_balance": (GOOD | {"frequencies": [2.0]}, {}),
    "clearance_sweep": (
        {"system": OSCILLATOR, "damper": {"mass_ratio": 0.12}, "frequency": 2.0}
        | {"clearances": [1.9, 2.0], "starts": 1},
        {"damper": no_damper | st.sampled_from([None, {"mass": 0.1}, {"clearance": 1}])},
    ),
    "basins": (
        GOOD | {"frequency": 1.95, "cells": 2},
        {"phase": no_start | negative, "shock": limit, "within": count},
    ),
    "migrate": (
        GOOD | {"frequency": 1.95},
        {"damper": no_damper | st.none(), "periods": count, "release": st.just("later")},
    ),
    "decode": (
        {"values": None},
        {"values": no_numbers | st.sampled_from([1, 2.0, [1, 2], OSCILLATOR, np.arange(3)])},
    ),
    "periodic_orbit": (MOVING, {}),
    "orbit_branches": (MOVING | {"span": (1.9, 2.1)}, {}),
}


def test_every_public_name_is_tried():
    assert set(FUNCTIONS) == set(idm.__all__) - {"plot"}


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_bad_argument_names_itself(name):
    function, (good, own) = getattr(idm, name), FUNCTIONS[name]
    taken = inspect.signature(function).parameters
    bad = {key: values for key, values in WRONG.items() if key in taken} | own

    @settings(max_examples=8 * len(bad))
    @given(st.sampled_from(sorted(bad)).flatmap(lambda k: st.tuples(st.just(k), bad[k])))
    def tried(case):
        key, value = case
        with pytest.raises((TypeError, ValueError)) as raised:
            function(**good | {key: value})
        told = str(raised.value)
        assert told.startswith((f"{key} = ", f"{key}[")), told
        assert ": must " in told and told.isprintable() and len(told) < 300, told

    tried()


def test_an_inelastic_damper_has_no_harmonic_balance():
    with pytest.raises(ValueError, match="restitution = 0.9: must be 1"):
        idm.harmonic_balance(OSCILLATOR, idm.Damper(0.12, 2.0, 0.9), [2.0])


def test_a_contact_too_fast_for_the_forcing_is_told():
    with pytest.raises(ValueError, match="contact_stiffness = 1e9: with mass_ratio = 1e-6 and"):
        idm.simulate(OSCILLATOR, idm.Damper(1e-6, 1.0, 1.0, 1e9), 2.0)
