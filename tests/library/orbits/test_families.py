"""Branches over several parameters, compared with closed forms and a scaling law."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from impact_damper.model.parameters import Oscillator
from impact_damper.orbits.orbit_branches import orbit_branches

FREQUENCY = 1.7


def harmonic(oscillator, frequency=FREQUENCY):
    """Return the complex amplitude of the steady motion of a linear oscillator."""
    o, w = oscillator, frequency
    return o.forcing_amplitude(w) / (o.linear_frequency**2 - w**2 + 1j * o.damping * w)


def at_strobe(amplitude, frequency=FREQUENCY):
    """Return the state at W T = pi/2 of the motion Re(amplitude exp(i W T))."""
    return (1j * amplitude).real, (-frequency * amplitude).real


@pytest.mark.parametrize(
    ("parameter", "span"), [("force", (0.0, 2.0)), ("unbalance", (0.0, 0.6)), ("damping", (0.1, 1))]
)
def test_branch_of_a_linear_oscillator(parameter, span):
    """Branches reach both ends of the span, even the force 0, and agree with the closed form."""
    own = {"damping": 0.2, "linear_frequency": 1.1, "cubic": 0.0, "force": 0.5, "unbalance": 0.2}
    own |= {"unbalance" if parameter == "force" else "force": 0.0}
    oscillator = Oscillator(**own)
    state = at_strobe(harmonic(oscillator))
    found = orbit_branches(oscillator, None, FREQUENCY, state, span=span, parameter=parameter)
    values = found["followed_value"].values
    assert_allclose([values.min(), values.max()], span, rtol=1e-12, atol=1e-12)
    expected = [abs(harmonic(Oscillator(**own | {parameter: value}))) for value in values]
    assert_allclose(found["orbit_displacement"], expected, atol=1e-9)
    assert len(found["event_kind"]) == 0


def test_a_branch_over_the_cubic_stiffness_passes_the_linear_oscillator():
    oscillator = Oscillator(1.2, 1.0, 0.05, 1.0)
    state = at_strobe(harmonic(oscillator))
    cubic = orbit_branches(oscillator, None, FREQUENCY, state, span=(-0.02, 4.0), parameter="cubic")
    values, size = cubic["followed_value"].values, cubic["orbit_displacement"].values
    linear = abs(harmonic(Oscillator(1.2, 1.0, 0.0, 1.0)))
    order = np.argsort(values)
    assert np.interp(0.0, values[order], size[order]) == pytest.approx(linear, rel=1e-4)
