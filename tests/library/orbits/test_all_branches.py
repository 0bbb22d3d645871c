"""Datasets of periodic orbits against the motion simulated from the stored state."""

import numpy as np
import pytest

from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.simulate import simulate
from impact_damper.motions.steady import steady_motion
from impact_damper.orbits.orbit_branches import orbit_branches, periodic_orbit

OSCILLATOR = Oscillator(damping=0.215)


@pytest.mark.parametrize("restitution", [1.0, 0.75])
def test_harmonics_and_restitution_of_an_orbit(restitution):
    damper = Damper(mass_ratio=0.25, clearance=1.0, restitution=restitution)
    frequency = 2.0
    steady = steady_motion(OSCILLATOR, damper, frequency, (0.05, 0, 0.9, 0.5))
    orbit = periodic_orbit(OSCILLATOR, damper, frequency, steady.state.values).isel(point=0)
    assert float(orbit.orbit_contacts) == 2
    motion = simulate(
        OSCILLATOR,
        damper,
        frequency,
        orbit.orbit_state.values,
        periods=1,
        samples=4096,
        start=float(orbit.orbit_phase) / frequency,
    ).isel(time=slice(None, -1))
    turn = np.exp(-1j * frequency * motion.time)
    first, second = (
        complex(2 * (motion[name] * turn).mean())
        for name in ("displacement", "relative_displacement")
    )
    # `Orbit.record` takes the first harmonics from 64 samples of a period. Kinks of the motion at
    # contacts cause errors, hence the tolerance of 2e-4.
    for phase, reference in (
        ("orbit_phase_relative", second),
        ("orbit_phase_loose", first - second),
    ):
        stored = float(orbit.orbit_amplitude) * np.exp(1j * float(orbit[phase]))
        assert stored == pytest.approx(first * abs(reference) / reference, abs=2e-4)
    ratio = np.abs(orbit.departure_velocity / orbit.approach_velocity)
    assert float(orbit.orbit_restitution) == pytest.approx(float(ratio.min()))
    assert float(orbit.orbit_restitution) == pytest.approx(restitution, rel=0.01)


def test_an_orbit_that_repeats_sooner_is_told_and_not_followed():
    damper = Damper(mass_ratio=0.25, clearance=1.0)
    steady = steady_motion(OSCILLATOR, damper, 2.0, (0.05, 0, 0.9, 0.5))
    assert int(steady.period) == 1
    state = steady.state.values
    with pytest.warns(UserWarning, match="period = 3: .* already repeats"):
        periodic_orbit(OSCILLATOR, damper, 2.0, state, period=3)
    with pytest.raises(ArithmeticError, match="period = 3: .* repeats after a divisor"):
        orbit_branches(OSCILLATOR, damper, 2.0, state, period=3, span=(1.9, 2.1))
