"""The best absorber by direct search: the linear limit, similar absorbers, and exact motions."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.data.datasets import flag
from impact_damper.design.absorber_problems import problems_of
from impact_damper.design.absorber_responses import absorber_responses
from impact_damper.design.absorber_seeds import harmonic_displacements
from impact_damper.design.direct import best_absorber
from impact_damper.design.linear_response import response
from impact_damper.design.tuning import exact_absorber
from impact_damper.model.machine import Machine

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005, "force": 40}
HARD = Machine(**SPRING, cubic_stiffness=4e9)
BAND = (20.0, 32.0)


@pytest.mark.thorough
def test_of_a_machine_that_is_nearly_linear():
    machine, band = Machine(**SPRING, cubic_stiffness=1.0), (16.0, 26.0)
    frequencies = np.linspace(*band, 2001)
    best, exact = (
        response(machine, design(machine, 0.6, band), frequencies).max()
        for design in (best_absorber, exact_absorber)
    )
    assert_allclose(best, exact, rtol=5e-3)


@pytest.mark.thorough
@pytest.mark.parametrize(
    "machine", [HARD, Machine(mass=12, cubic_stiffness=4e9, damping=15, force=40)]
)
def test_no_absorber_nearby_is_better(machine):
    absorber = best_absorber(machine, 0.6, BAND)

    def worst(each):
        problems = problems_of(machine, each, np.linspace(*BAND, 61), [1.0])
        return harmonic_displacements(problems).max()

    least = worst(absorber)
    for name in ("stiffness", "damping", "cubic_stiffness"):
        for factor in (0.9, 0.97, 1.03, 1.1):
            other = replace(absorber, **{name: getattr(absorber, name) * factor})
            assert worst(other) > least * (1 - 1e-2)


@pytest.mark.thorough
def test_it_is_better_by_exact_motions():
    data = absorber_responses(HARD, 0.6, np.linspace(*BAND, 25), [1.0], detunings=[0.0])
    worst = data["competitor_displacement"].max("frequency").squeeze().to_series()
    assert worst["best"] < 0.9 * worst["nonlinear"] < 0.9 * worst["tuned"] < 0.3 * worst["bare"]
    assert (data["competitor_status"] == flag("competitor_status", "found")).all()


def test_a_linear_spring_is_refused():
    with pytest.raises(ValueError, match="exact_absorber is exact"):
        best_absorber(Machine(**SPRING), 0.6, BAND)
