"""Design rule (19) for the clearance. Imports no NumPy, since the workflow evaluates it too."""

import math


def peak_frequency(oscillator) -> float:
    """Peak frequency Wp of rule (19), at which Z1 without the damper lags by a quarter period.

    Defined by a = f/(h W) and W^2 = wl^2 + (3/4) k3 a^2 (section 2.1) with the forcing amplitude
    f = F + U W^2 + V/W^2, so without V, which only a linear spring has, Wp^2 = s solves

        (1 - g U^2/h^2) s^2 - (wl^2 + 2 g F U/h^2) s - g F^2/h^2 = 0,   g = (3/4) k3.

    Of the two solutions with a softening spring, the one with the smaller amplitude is the peak.
    Dimensionless. The maximum of the response curve lies slightly below, see
    `free_oscillator.maximum_response`.

    Raises
    ------
    ValueError
        If no motion lags by a quarter period: neither stiffness is positive; or the motion goes
        over the barrier of a softening spring at a lower amplitude; or with a hardening spring the
        unbalance outgrows the damping.
    """
    stiffness, hardening = oscillator.linear_frequency**2, oscillator.hardening
    scale = hardening / oscillator.damping**2
    share = 1 - scale * oscillator.unbalance**2
    middle = stiffness + 2 * scale * oscillator.force * oscillator.unbalance
    if share <= 0:
        raise ValueError(
            f"unbalance = {oscillator.unbalance:g}: the response has no peak, it grows with the "
            f"frequency without end; with cubic = {oscillator.cubic:g} and damping = "
            f"{oscillator.damping:g} a peak needs less than unbalance = "
            f"{oscillator.damping / math.sqrt(hardening):g}"
        )
    cubic = 2 * math.sqrt(abs(hardening)) * oscillator.force / oscillator.damping
    middle, cubic = middle / share, cubic / math.sqrt(share)
    if hardening < 0 and middle < cubic:
        raise ValueError(
            f"force = {oscillator.force:g}: the response has no peak, the motion goes over the "
            f"barrier of the softening spring (cubic = {oscillator.cubic:g}) before"
        )
    if hardening < 0:
        root = math.sqrt((middle - cubic) * (middle + cubic))
    else:
        root = math.hypot(middle, cubic)
    if middle + root <= 0:
        raise ValueError(
            f"linear_frequency = {oscillator.linear_frequency:g}, cubic = {oscillator.cubic:g}, "
            f"force = {oscillator.force:g}: the response has no peak, nothing restores the mass"
        )
    return math.sqrt((middle + root) / 2)


def rule_clearance(oscillator, mass_ratio) -> float:
    """Clearance d0 = f/(rm Wp^2) of rule (19), dimensionless.

    With this clearance the amplitude a = 0 solves (13) at the peak frequency Wp. The forcing
    amplitude is f = F + U Wp^2.

    Raises
    ------
    ValueError
        If there is no peak, or no forcing.
    """
    peak = peak_frequency(oscillator)
    forcing = oscillator.forcing_amplitude(peak)
    if forcing == 0:
        raise ValueError("force = 0, unbalance = 0: the rule for the clearance needs a forcing")
    return forcing / (mass_ratio * peak**2)
