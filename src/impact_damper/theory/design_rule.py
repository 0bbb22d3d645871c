"""Design rule (19) for the clearance. Imports no NumPy, since the workflow evaluates it too."""

import math


def peak_frequency(oscillator) -> float:
    """Peak frequency Wp of rule (19), at which Z1 without the damper lags by a quarter period.

    Defined by a = 1/(h W) and W^2 = wl^2 + (3/4) a^2 (section 2.1), so Wp solves
    W^4 - wl^2 W^2 - 3/(4 h^2) = 0. Dimensionless. The maximum of the response curve lies slightly
    below, see `free_oscillator.maximum_response`.
    """
    stiffness = oscillator.linear_frequency**2
    cubic = 2 * math.sqrt(oscillator.hardening) / oscillator.damping
    return math.sqrt((stiffness + math.hypot(stiffness, cubic)) / 2)


def rule_clearance(oscillator, mass_ratio) -> float:
    """Clearance d0 = 1/(rm Wp^2) of rule (19), at which a = 0 solves (13) at Wp; dimensionless."""
    return 1 / (mass_ratio * peak_frequency(oscillator) ** 2)
