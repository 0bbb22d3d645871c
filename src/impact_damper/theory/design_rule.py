"""The paper's design rule (19) for the clearance, without NumPy, for fast dry runs of Snakemake."""

import math


def peak_frequency(oscillator) -> float:
    """Return the dimensionless peak frequency Wp of rule (19). Raise ValueError without a peak.

    At Wp the displacement Z1 without the damper lags the forcing by a quarter of a cycle. By
    section 2.1 of the paper, s = Wp^2 solves the following equation with g = (3/4) k3.

        (1 - g U^2/h^2) s^2 - (wl^2 + 2 g F U/h^2) s - g F^2/h^2 = 0

    With a softening spring there are two solutions; Wp^2 is the larger s. The maximum of the
    response curve (`free_oscillator.maximum_response`) lies at a frequency slightly below Wp if
    U = 0, and slightly above Wp if F = 0.
    """
    stiffness, hardening = oscillator.linear_frequency**2, oscillator.hardening
    scale = hardening / oscillator.damping**2
    leading = 1 - scale * oscillator.unbalance**2
    middle = stiffness + 2 * scale * oscillator.force * oscillator.unbalance
    if leading <= 0:
        most = oscillator.damping / math.sqrt(hardening)
        raise ValueError(
            f"{oscillator.told('unbalance')}: the response has no peak, it grows with the "
            f"frequency without end; with {oscillator.told('cubic', 'damping')} a peak needs less "
            f"than {oscillator.scales.told('unbalance', most, 'unbalance')}"
        )
    cubic = 2 * math.sqrt(abs(hardening)) * oscillator.force / oscillator.damping
    middle, cubic = middle / leading, cubic / math.sqrt(leading)
    if hardening < 0 and middle < cubic:
        raise ValueError(
            f"{oscillator.told('force')}: the response has no peak, the motion goes over the "
            f"barrier of the softening spring ({oscillator.told('cubic')})"
        )
    if hardening < 0:
        root = math.sqrt((middle - cubic) * (middle + cubic))
    else:
        root = math.hypot(middle, cubic)
    if middle + root <= 0:
        raise ValueError(
            f"{oscillator.told('linear_frequency', 'cubic', 'force')}: the response has no peak, "
            "nothing restores the mass"
        )
    return math.sqrt((middle + root) / 2)


def rule_clearance(oscillator, mass_ratio) -> float:
    """Return the clearance d0 = f/(rm Wp^2) of rule (19). f is the forcing amplitude at Wp."""
    peak = peak_frequency(oscillator)
    forcing = oscillator.forcing_amplitude(peak)
    if forcing == 0:
        raise ValueError(
            f"{oscillator.told('force', 'unbalance')}: the rule for the clearance needs a forcing"
        )
    return forcing / (mass_ratio * peak**2)
