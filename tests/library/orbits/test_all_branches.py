"""Datasets of periodic orbits against the motion simulated from the stored state."""

import numpy as np
import pytest

from chatterjee1995.tables import motions
from impact_damper.data.datasets import dataset, decode
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator, describe
from impact_damper.motions.simulate import simulate
from impact_damper.motions.steady import steady_motion
from impact_damper.orbits.branch_datasets import branches_dataset, torus_variables
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit_branch import orbit_branch, periodic_orbit
from impact_damper.orbits.shooting import find_orbit

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
    # `Orbit.record` takes the first harmonics from 64 samples of a period. The kinks of the motion
    # at contacts cause the tolerance of 2e-4 below.
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
        orbit_branch(OSCILLATOR, damper, 2.0, state, period=3, span=(1.9, 2.1))


def test_only_neimark_sacker_points_have_tori_and_the_table_lists_each_once():
    """The stable torus of the damper of figure 10 begins at a point that lies on two branches."""
    damper = Damper(0.25, 1.0, restitution=0.75)

    def family(value):
        return pack(OSCILLATOR, damper, value)

    orbit = find_orbit(family(1.6), (0.7796, 0.1704, 0.8163, -0.9718), 3)
    branches = [follow_branch(family, orbit, 1.6, (1.59, span)) for span in (1.61, 1.8)]
    made = describe(OSCILLATOR, damper) | {"parameter": "frequency"}
    found = branches_dataset(branches, float, made, "Branches")
    found = found.assign(dataset(torus_variables(branches), {}, made, "Tori").variables)
    kinds, points = decode(found.torus_kind), decode(found.event_kind) == "neimark_sacker"
    assert list(kinds[points]) == ["stable", "stable"] and np.all(kinds[~points] == "absent")
    assert np.all(np.isfinite(found.torus_angle) == points)
    (row,) = motions.tori({"branches": {"figure_10": found}}).to_dict("records")
    assert float(row["W"]) == pytest.approx(1.59352297, abs=1e-7)
    assert row["first frequency"] == pytest.approx(float(row["W of torus"]) / 3)
    second = float(row["angle"]) * row["first frequency"]
    assert float(row["second frequency"]) == pytest.approx(second, abs=1e-4)
