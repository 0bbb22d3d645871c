"""What theory says of the optimum clearance by equations (7), against what is found."""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from impact_damper.data.datasets import flag
from impact_damper.theory import single_harmonic as balance
from impact_damper.theory.slow_flow import fixed_points, growth_rate, stability
from impact_damper.theory.straight_flight import Flight, least_displacement_ratio

FIRST_HARMONIC_RATIO = np.pi**2 / 8
ZERO_AMPLITUDE = 1e-6


def straight_flight_ratio(mass_ratio, restitution=1.0) -> float:
    """rm W^2 d0 for which max |Z1| is least, in the limit of high frequency and rigid walls.

    There spring and damping do not count, and the loose mass flies straight: see `flight.Flight`.
    For e = 1 it is 1.1382 + 0.1382 rm.

    Parameters
    ----------
    mass_ratio, restitution : float
        rm and e.
    """
    return least_displacement_ratio(Flight(mass_ratio, restitution))


def _analytical(oscillator, damper, frequency):
    """Signed a of the stable solution of (7) with the smallest |a|, and how the search ended."""
    if damper.restitution != 1:
        return np.nan, "inelastic"
    try:
        solutions = balance.impacting_solutions(oscillator, damper, frequency)
    except ArithmeticError:
        return np.nan, "unresolved"
    growth = growth_rate(fixed_points(solutions), oscillator, damper, frequency)
    stable = solutions.amplitude[stability(growth) == flag("stability", "stable")]
    return (min(stable, key=abs), "found") if len(stable) else (np.nan, "absent")


def analytical_table(oscillator, dampers, frequency):
    """|a| of (7) over the sweep, and the clearance where a vanishes."""
    signed, status = zip(
        *(_analytical(oscillator, each, frequency) for each in dampers), strict=True
    )
    signed = np.array(signed)
    best, kind = np.nan, "not_found"

    def amplitude(clearance):
        return _analytical(oscillator, replace(dampers[0], clearance=clearance), frequency)[0]

    for k in np.flatnonzero(signed[1:] * signed[:-1] < 0):
        place = brentq(amplitude, dampers[k].clearance, dampers[k + 1].clearance)
        # the sign may change by a jump to another solution as well
        if abs(amplitude(place)) < ZERO_AMPLITUDE:
            best, kind = place, "kink"
    return {
        "analytical_amplitude": np.abs(signed),
        "analytical_status": np.array([flag("analytical_status", each) for each in status]),
        "analytical_optimum": best,
        "analytical_kind": flag("optimum_kind", kind),
    }


def excess_table(ratio, damper):
    """rm W^2 d0 at the optimum, and the shares of its excess over 1 that are explained."""
    straight = straight_flight_ratio(damper.mass_ratio, damper.restitution)
    harmonic = FIRST_HARMONIC_RATIO if damper.restitution == 1 else np.nan
    return {
        "optimum_ratio": ratio,
        "straight_flight_ratio": straight,
        "first_harmonic_share": (harmonic - 1) / (ratio - 1),
        "straight_flight_share": (straight - 1) / (ratio - 1),
    }
