"""Rules for the clearance, each for two criteria of the optimum."""

import numpy as np

from impact_damper.theory.optimum_clearance import FIRST_HARMONIC_RATIO
from impact_damper.theory.straight_flight import (
    Flight,
    elastic_ratios,
    flight_of,
    least_displacement_ratio,
    least_harmonic_ratio,
)

# What is least at the optimum.
CRITERIA = ("displacement", "first_harmonic")
RULES = ("balance", "gap_harmonic", "straight_flight", "elastic", "flight")


def rule_ratios(oscillator, damper, frequency):
    """Return rm W^2 d0 by each rule for each criterion, shape (2, 5), as `CRITERIA` and `RULES`.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
        Of any clearance.
    frequency : float
    """
    flight = flight_of(oscillator, damper, frequency)
    straight = Flight(damper.mass_ratio, damper.restitution)
    elastic = elastic_ratios(flight)
    return np.array(
        [
            [1.0, FIRST_HARMONIC_RATIO, least(straight), elastic[i], least(flight)]
            for i, least in enumerate((least_displacement_ratio, least_harmonic_ratio))
        ]
    )
