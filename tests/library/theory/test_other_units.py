"""A system and the same system in other units of length and time have the same results."""

import numpy as np
import pytest
from helpers.springs import KNOWN, SPRINGS, in_other_units
from numpy.testing import assert_allclose

from chatterjee1995.stages import convergence
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper
from impact_damper.theory.design_rule import peak_frequency, rule_clearance
from impact_damper.theory.free_oscillator import (
    free_folds,
    free_solutions,
    main_solutions,
    maximum_response,
)
from impact_damper.theory.optimum_clearance import rule_ratios
from impact_damper.theory.single_harmonic import (
    impacting_solutions,
    resting_solutions,
    rigid_solutions,
)
from impact_damper.theory.slow_flow import fixed_points, growth_rate
from impact_damper.theory.suppression_band import suppression_band

DAMPER = Damper(0.12, 1.5, contact_stiffness=400.0)


@pytest.fixture(params=KNOWN)
def oscillator(request):
    return KNOWN[request.param]


UNITS = [(0.25, 4.0), (16.0, 0.125)]


@pytest.mark.parametrize("length, time", UNITS)
def test_the_same_system_in_other_units(oscillator, length, time):
    """Amplitudes scale with the length, frequencies and rates with the time."""
    frequency = 1.45
    other, damper, fast = in_other_units(oscillator, DAMPER, frequency, length, time)
    assert_allclose(peak_frequency(other), peak_frequency(oscillator) * time, rtol=1e-12)
    assert_allclose(
        rule_clearance(other, 0.12), rule_clearance(oscillator, 0.12) / length, rtol=1e-12
    )
    for ours, theirs in (
        (free_folds(oscillator), free_folds(other)),
        ([maximum_response(oscillator)], [maximum_response(other)]),
    ):
        scaled = np.array(ours).reshape(-1, 2) * [time, 1 / length]
        assert_allclose(np.array(theirs).reshape(-1, 2), scaled, rtol=1e-9)
    for solutions in (
        lambda *system: free_solutions(system[0], system[2]),
        impacting_solutions,
        resting_solutions,
    ):
        ours, theirs = solutions(oscillator, DAMPER, frequency), solutions(other, damper, fast)
        assert_allclose(theirs.amplitude, ours.amplitude / length, rtol=1e-9)
        assert_allclose(theirs.phase, ours.phase, atol=1e-9)
    ours = rigid_solutions(oscillator, DAMPER, frequency)
    theirs = rigid_solutions(other, damper, fast)
    assert_allclose(theirs.amplitude, ours.amplitude / length, rtol=1e-9)
    assert_allclose(theirs.residual, ours.residual * time**2 / length, atol=1e-9)
    ours, theirs = (
        growth_rate(fixed_points(impacting_solutions(*each)), *each)
        for each in ((oscillator, DAMPER, frequency), (other, damper, fast))
    )
    assert_allclose(theirs, ours * time, rtol=1e-6)
    if frequency > oscillator.linear_frequency:
        ours = rule_ratios(oscillator, DAMPER, frequency)
        assert_allclose(rule_ratios(other, damper, fast), ours, rtol=1e-9)


@pytest.mark.thorough
@pytest.mark.parametrize("length, time", UNITS[:1])
@pytest.mark.parametrize("name", ["softening", "shaken", "linear"])
def test_singularities_and_bands_in_other_units(name, length, time):
    oscillator = SPRINGS[name]
    other, damper, fast = in_other_units(oscillator, DAMPER, 1.2, length, time)
    a = main_solutions(oscillator, 1.2).amplitude[-1]
    near = convergence.singularity_distance(pack(oscillator, None, 1.2), np.array([a, 0, a, 0]))
    state = np.array([a, 0, a, 0]) / length
    scaled = convergence.singularity_distance(pack(other, None, fast), state)
    assert_allclose(scaled, near / time, rtol=1e-6)
    assert (name == "linear") == np.isinf(near)
    clearance = rule_clearance(oscillator, 0.12)
    bands = [
        suppression_band(oscillator, Damper(0.12, clearance)),
        suppression_band(
            other, Damper(0.12, clearance / length, contact_stiffness=2000.0 * time**2)
        ),
    ]
    assert bands[0].band_status == bands[1].band_status
    assert (bands[0].edge_event == bands[1].edge_event).all()
    assert_allclose(bands[1].edge_frequency, bands[0].edge_frequency * time, rtol=1e-8)
    assert_allclose(bands[1].reduction, bands[0].reduction, rtol=1e-8)
