"""Stable orbits with small basins of attraction, which Newton's method finds and starts miss."""

import numpy as np
import pytest

import impact_damper as idm
from impact_damper.data.datasets import flag
from impact_damper.motions import start_states

NEVER = np.zeros(1, bool)
# Oscillator, damper, frequency, and max |Z1| and period of an orbit that few random starts lead to.
RARE = [
    (
        idm.Oscillator(0.11048, 1.0, cubic=0.0030857, force=0.32103),
        idm.Damper(0.042979, 3.38804, 0.99667, 2799.53),
        0.99966,
        (2.600, 1),
    ),
    (
        idm.Oscillator(0.066086, 1.0, cubic=-0.011362, force=0.068981),
        idm.Damper(0.076894, 1.25925, 0.76231, 11897.3),
        0.88489,
        (0.529, 3),
    ),
]


@pytest.mark.parametrize(("oscillator", "damper", "frequency", "rare"), RARE)
@pytest.mark.parametrize("seed", [1])
def test_a_search_finds_an_orbit_to_which_no_start_leads(
    oscillator, damper, frequency, rare, seed, monkeypatch
):
    monkeypatch.setattr(start_states, "_placed", lambda *_: start_states.NO_STARTS)
    found = idm.frequency_response(oscillator, damper, [frequency], starts=8, seed=seed)
    found = found.isel(frequency=0)
    size, period = rare
    (place,) = np.flatnonzero(
        (abs(found.maximum_displacement - size) < 2e-3) & (found.period == period)
    )
    one = found.isel(motion=place)
    assert one.origin == flag("origin", "followed") and one.motion_starts == 0
    # the integrator alone, without Newton's method, stays on the orbit
    run = idm.simulate(oscillator, damper, frequency, one.state, periods=20 * period)
    np.testing.assert_allclose(run.displacement[-1], run.displacement[0], atol=1e-6)
