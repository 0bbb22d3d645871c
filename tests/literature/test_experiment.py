"""Decay of a cantilever with lead particles; docs/explanation/experiment.md has all values."""

import numpy as np

from impact_damper import Machine, simulate
from impact_damper.model.machine import GRAVITY

MEASURED = 0.5
FREQUENCY, RELEASED = 20.0, 15.0  # Hz; displacement at release in units of g/w^2
UNIT = GRAVITY / (2 * np.pi * FREQUENCY) ** 2
MACHINE = Machine(mass=1.0, natural_frequency=FREQUENCY, damping_ratio=1e-4, force=0.0)
STIFFNESS = 3e3 * MACHINE.linear_stiffness


def largest_capacity(mass_ratio, restitution):
    """Return the largest share of energy lost in a cycle, over amplitudes and gaps."""
    return max(
        _capacities(
            MACHINE.damper(
                mass=mass_ratio,
                gap=gap * UNIT,
                restitution=restitution,
                contact_stiffness=STIFFNESS * mass_ratio,
                mount={"inclination": "90 deg"},
            )
        ).max()
        for gap in np.geomspace(4, 80, 16)
    )


def _capacities(damper):
    """Return shares of energy lost from each maximum of a decay to the next, except the first."""
    state = (RELEASED * UNIT, 0.0, damper.gap / 2, 0.0)  # at rest on the lower wall
    x = simulate(MACHINE, damper, FREQUENCY, state, periods=14)["displacement"].values / 1e3 / UNIT
    peaks = x[1:-1][(x[1:-1] >= x[:-2]) & (x[1:-1] > x[2:])]
    peaks = peaks[: np.argmax(np.append(peaks, 0.0) < 1.5)]  # later the mass rests on its wall
    return np.append(1 - (peaks[1:] / peaks[:-1]) ** 2, 0.0)


def test_friend_and_kinra():
    """The measured value lies between predictions for the least and largest assumed values.

    The modal mass of a cantilever is a quarter of its mass, so rm could be four times as large.
    """
    assert largest_capacity(0.055, 0.05) < MEASURED < largest_capacity(0.065, 0.3)
    assert largest_capacity(4 * 0.06, 0.05) > 1.5 * MEASURED
