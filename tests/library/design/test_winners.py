"""Displacements of the configured machines with their best absorbers, against SciPy.

The best absorber of the comparison is called the winner on some pages. SciPy integrates the machine
with this absorber at the frequency of its largest displacement, from rest and from a random start.
The absorber is as designed, or detuned to the worse side. The larger of both motions must have the
displacement that the comparison states.
"""

import numpy as np
import pytest
from helpers import configurations
from scipy.integrate import solve_ivp

from impact_damper.design.absorber_responses import absorber_responses
from impact_damper.model.machine import Machine

pytestmark = pytest.mark.thorough

MACHINES = configurations.read()["machines"]
PERIODS, SAMPLES = 120, 64


def largest(machine, values, mass, hertz, start):
    """Return the largest displacement (m) in the last ten of PERIODS cycles, in SI units."""
    stiffness, damping, cubic = values
    c, angular = machine.viscous_damping, 2 * np.pi * hertz
    amplitude = machine.force
    if machine.base_displacement is not None:
        through = np.hypot(machine.linear_stiffness, c * angular)
        amplitude = machine.base_displacement * through

    def rate(t, y):
        x, v, u, w = y
        link = stiffness * u + damping * w + cubic * u**3
        total = amplitude * np.cos(angular * t) - c * v - machine.linear_stiffness * x
        a = (total - machine.cubic_stiffness * x**3 - link) / machine.mass
        return [v, a, w, a - link / mass]

    times = np.arange((PERIODS - 10) * SAMPLES, PERIODS * SAMPLES + 1) / (SAMPLES * hertz)
    run = solve_ivp(rate, (0, times[-1]), start, "DOP853", times, rtol=1e-8, atol=1e-12)
    return np.abs(run.y[0]).max()


@pytest.mark.parametrize("name", ["board", "pump_wide_band", "cabinet"])
def test_the_winner_moves_as_far_as_the_comparison_says(name):
    entry, generator = MACHINES[name], np.random.default_rng(1995)
    machine, ends = Machine(**entry["machine"]), [entry["band"][end] for end in ("first", "last")]
    mass = machine.damper(**entry["damper"], gap=1e-2).mass
    frequencies = np.linspace(*ends, 3)
    data = absorber_responses(machine, mass, frequencies, [1.0], band=(0.5 * ends[0], 2 * ends[1]))
    data = data.squeeze("force_share")
    worst = data["competitor_displacement"].max("frequency")
    best = str(worst.competitor.values[int(np.nanargmin(worst.sel(detuning=0)))])
    detuned = max((-0.1, 0.1), key=lambda each: worst.sel(competitor=best, detuning=each))
    for detuning in (0.0, detuned):
        built = data.sel(competitor=best, detuning=detuning)
        values = [
            float(built[f"absorber_{each}"]) for each in ("stiffness", "damping", "cubic_stiffness")
        ]
        k = int(np.argmax(built["competitor_displacement"].values))
        expected = 1e-3 * float(built["competitor_displacement"][k])
        scale = expected * np.array([1, 2 * np.pi * frequencies[k]] * 2)
        starts = [np.zeros(4), generator.uniform(-2, 2, 4) * scale]
        sizes = [largest(machine, values, mass, frequencies[k], start) for start in starts]
        assert max(sizes) == pytest.approx(expected, rel=2e-3), (best, detuning)
