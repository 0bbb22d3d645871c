"""Rule (19) for the clearance, which the workflow needs too: this module imports no NumPy."""

import math


def peak_frequency(oscillator) -> float:
    """Peak frequency Wp of rule (19): there the free motion lags by a quarter of a period.

    With a = 1/(h W) and W^2 = wl^2 + (3/4) a^2 it solves W^4 - wl^2 W^2 - 3/(4 h^2) = 0,
    by definition. The curve's exact maximum, a little below, is `maximum_response`.
    """
    stiffness = oscillator.linear_frequency**2
    return math.sqrt((stiffness + math.hypot(stiffness, math.sqrt(3) / oscillator.damping)) / 2)


def rule_clearance(oscillator, mass_ratio) -> float:
    """Clearance d0 = 1/(rm Wp^2) of rule (19), for which a = 0 solves (13) at the peak."""
    return 1 / (mass_ratio * peak_frequency(oscillator) ** 2)
