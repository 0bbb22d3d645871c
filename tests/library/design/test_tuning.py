"""Tuned absorbers: equal peaks, the closed forms for an undamped machine, and nonsense refused."""

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.design.linear_response import linear_machine, maxima, response, tuning_of
from impact_damper.design.tuning import (
    den_hartog_absorber,
    exact_absorber,
    nonlinear_absorber,
    undamped_optimum,
)
from impact_damper.model.machine import Machine
from impact_damper.theory.tuned_mass_damper import fixed_point

SPRING = {"mass": 12, "linear_stiffness": 2e5}
LINEAR = Machine(**SPRING, damping_ratio=0.005, force=40)
UNDAMPED = Machine(**SPRING, damping_ratio=1e-8, force=40)
EXCITED = {
    "force": LINEAR,
    "damped": replace(LINEAR, damping_ratio=0.1),
    "unbalance": Machine(**SPRING, damping_ratio=0.01, unbalance=0.002),
    "base": Machine(**SPRING, damping_ratio=0.01, base_displacement=2e-4),
}


@pytest.mark.parametrize("mass", [0.12, 0.6, 6])
def test_without_damping_the_optimum_is_the_closed_form(mass):
    exact, closed = exact_absorber(UNDAMPED, mass), undamped_optimum(UNDAMPED, mass)
    assert_allclose(exact.stiffness, closed.stiffness, rtol=1e-6)
    assert_allclose(exact.damping, closed.damping, rtol=1e-6)


@pytest.mark.parametrize("name", EXCITED)
def test_peaks_are_equal_and_no_other_tuning_has_lower_ones(name):
    machine = EXCITED[name]
    absorber, linear = exact_absorber(machine, 0.6), linear_machine(machine)
    limits = (0.0, math.inf)
    heights = np.sort(maxima(linear, tuning_of(machine, absorber), limits)[1])
    assert_allclose(heights[-1], heights[-2], rtol=1e-9)
    frequencies = np.linspace(10, 40, 40001)
    best = response(machine, absorber, frequencies).max()
    assert_allclose(best**2, linear.unit**2 * heights[-1], rtol=1e-6)
    for stiffness in (0.99, 1, 1.01):
        for damping in (0.97, 1, 1.03):
            other = replace(
                absorber,
                stiffness=stiffness * absorber.stiffness,
                damping=damping * absorber.damping,
            )
            assert response(machine, other, frequencies).max() >= best * (1 - 1e-9)


def test_den_hartogs_fixed_points():
    """Response curves for two dampings cross at sqrt(1 + 2/m) static deflections.

    m is the mass ratio.
    """
    absorber, frequencies = den_hartog_absorber(UNDAMPED, 0.6), np.linspace(15, 26, 200001)
    first, second = (
        response(UNDAMPED, replace(absorber, damping=d), frequencies) for d in (10.0, 30.0)
    )
    crossed = np.flatnonzero(np.diff(np.sign(first - second)))
    assert_allclose(first[crossed] / (40 / 2e5), fixed_point(0.05), rtol=1e-4)


def test_in_a_band_an_end_is_as_high_as_another_place():
    absorber, linear = exact_absorber(LINEAR, 0.6, (20, 21.5)), linear_machine(LINEAR)
    limits = tuple(f / LINEAR.natural_frequency for f in (20, 21.5))
    heights = np.sort(maxima(linear, tuning_of(LINEAR, absorber), limits)[1])
    assert_allclose(heights[-1], heights[-2], rtol=1e-6)


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda: exact_absorber(LINEAR, 13), "mass = 13 kg: must be at least"),
        (lambda: exact_absorber(LINEAR, 0.6, (22, 20)), "in order"),
        (lambda: nonlinear_absorber(LINEAR, 0.6), "with a linear spring use exact_absorber"),
        (
            lambda: exact_absorber(Machine(mass=2, cubic_stiffness=1e6, damping=1, force=3), 0.1),
            "no natural frequency",
        ),
        (
            lambda: exact_absorber(Machine(**SPRING, damping=9, base_acceleration=3), 0.6),
            "band = None: must be given",
        ),
    ],
)
def test_nonsense_is_refused(call, told):
    with pytest.raises(ValueError, match=told):
        call()
