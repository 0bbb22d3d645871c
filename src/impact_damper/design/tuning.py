"""Ways to tune an absorber of given mass to a machine.

`exact_absorber` is the H-infinity optimum, which minimises the largest displacement over all
frequencies or over a band. It is computed for the given machine with its damping and its kind of
excitation. `den_hartog_absorber` and `undamped_optimum` are closed forms for an undamped machine
under a force. `nonlinear_absorber` adds a cubic spring that keeps the peaks equal on a machine with
a cubic spring. All functions require a linear stiffness of the machine, because a machine without
linear stiffness has no natural frequency to which an absorber can be tuned.
"""

import math
from dataclasses import replace

import numpy as np
from scipy.optimize import minimize_scalar

from impact_damper.design.absorber import TunedAbsorber, check_mass
from impact_damper.design.linear_response import linear_machine, maxima
from impact_damper.model.bounds import shown
from impact_damper.theory.nonlinear_absorber import tuned_cubic
from impact_damper.theory.tuned_mass_damper import Tuning, den_hartog, exact_optimum

# Grid on which the optimum is found before it is refined. It lies around the closed form
# `exact_optimum`:
# STEPS          number of tunings on each side of the tuning of the closed form
# NARROW, WIDE   smallest and largest difference of the logarithms of these tunings from the closed
#                form; NARROW in units of the square root of the mass ratio, the resonance's width
# DAMPINGS       damping ratios divided by the damping ratio of the closed form
# For a band the grid also has:
# PLACES         number of tunings, spread evenly over the band
# BAND_DAMPINGS  damping ratios
STEPS, NARROW, WIDE = 10, 0.1, 0.4
DAMPINGS = np.geomspace(0.3, 10, 12)
PLACES = 9
BAND_DAMPINGS = np.geomspace(1e-3, 0.3, 10)
# Tolerances of the logarithms of tuning and damping ratio when the optimum is refined.
TUNING_TOLERANCE, DAMPING_TOLERANCE = 1e-11, 1e-10


def den_hartog_absorber(machine, mass) -> TunedAbsorber:
    """Return the absorber with Den Hartog's tuning and Brock's damping, for an undamped machine.

    Raises
    ------
    TypeError, ValueError
        If the mass is out of range, or the machine has no linear stiffness.
    """
    return _absorber(machine, den_hartog(_mass_ratio(machine, mass)))


def undamped_optimum(machine, mass) -> TunedAbsorber:
    """Return the absorber of the exact optimum of Nishihara and Asami, for an undamped machine.

    Raises
    ------
    TypeError, ValueError
        If the mass is out of range, or the machine has no linear stiffness.
    """
    return _absorber(machine, exact_optimum(_mass_ratio(machine, mass)))


def exact_absorber(machine, mass, band=None) -> TunedAbsorber:
    """Return the absorber that minimises the largest displacement over a band.

    The machine's cubic stiffness is ignored. At the optimum the two highest maxima, or a maximum
    and an end of the band, are equally high.

    Parameters
    ----------
    machine : Machine
    mass : float, str or pint.Quantity
        kg.
    band : sequence of 2 floats, optional
        Lowest and highest forcing frequency, Hz; by default all frequencies. In a narrow band the
        best damping is small. Damping ratios below BAND_DAMPINGS[0] are not tried.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range, if the machine has no linear stiffness, or if the machine
        has a `base_acceleration` and `band` is not given.
    """
    ratio, linear = _mass_ratio(machine, mass), linear_machine(machine)
    limits = _limits(machine, linear, band)

    def highest(log_tuning, log_damping):
        tuning = Tuning(ratio, math.exp(log_tuning), math.exp(log_damping))
        return maxima(linear, tuning, limits)[1].max()

    def best_tuning(log_damping):
        # At the optimum two maxima cross. A method that fits parabolas would stop too early there.
        return minimize_scalar(
            highest, bracket=tunings, args=(log_damping,), method="golden", tol=TUNING_TOLERANCE
        )

    tunings, dampings = _around_optimum(ratio, limits, highest)
    damping = minimize_scalar(
        lambda log: best_tuning(log).fun,
        bounds=dampings,
        method="bounded",
        options={"xatol": DAMPING_TOLERANCE},
    ).x
    return _absorber(machine, Tuning(ratio, math.exp(best_tuning(damping).x), math.exp(damping)))


def nonlinear_absorber(machine, mass, band=None) -> TunedAbsorber:
    """Return the absorber of `exact_absorber` with an additional cubic spring.

    The cubic stiffness is 2 m^2 k3/(1 + 4 m) for the mass ratio m and the cubic stiffness k3 of the
    machine (Habib, Detroux, Viguie and Kerschen 2015). With this stiffness the two peaks stay equal
    to first order in the cubic force. For a softening machine the absorber is softening too.

    Raises
    ------
    TypeError, ValueError
        As `exact_absorber`, and if the machine's spring is linear. For a linear spring use
        `exact_absorber`.
    """
    if check_mass(machine, mass) and machine.cubic_stiffness == 0:
        raise ValueError(
            "cubic_stiffness = 0 N/m^3: must not be 0 for a nonlinear absorber; for a machine "
            "with a linear spring use exact_absorber"
        )
    return with_cubic(machine, exact_absorber(machine, mass, band))


def with_cubic(machine, absorber) -> TunedAbsorber:
    """Return an absorber with the cubic spring that `nonlinear_absorber` describes."""
    cubic = tuned_cubic(absorber.mass / machine.mass, machine.cubic_stiffness)
    return replace(absorber, cubic_stiffness=cubic)


def _mass_ratio(machine, mass):
    return check_mass(machine, mass) / machine.mass


def _absorber(machine, tuning):
    """Return the absorber in SI units with a given dimensionless tuning on a machine."""
    linear = linear_machine(machine)
    mass = tuning.mass_ratio * machine.mass
    own = 2 * math.pi * linear.natural_frequency * tuning.frequency
    return TunedAbsorber(
        mass=mass, stiffness=mass * own**2, damping=2 * mass * tuning.damping_ratio * own
    )


def check_band(machine, band) -> tuple:
    """Return lowest and highest frequency of a band in Hz.

    Raises
    ------
    TypeError, ValueError
        If the band is not a pair of frequencies in ascending order; the message names it.
    """
    if np.ndim(band) != 1 or len(band) != 2:
        raise TypeError(f"band = {shown(band)}: must be lowest and highest frequency")
    ends = tuple(machine.check_frequency(f"band[{place}]", end) for place, end in enumerate(band))
    if ends[0] >= ends[1]:
        raise ValueError(f"band = {shown(band)}: must be lowest and highest frequency, in order")
    return ends


def _limits(machine, linear, band):
    """Return a band as lowest and highest r, frequencies divided by the natural frequency."""
    if band is not None:
        return tuple(end / linear.natural_frequency for end in check_band(machine, band))
    if linear.falling:
        raise ValueError(
            "band = None: must be given with base_acceleration (the displacement grows without "
            "limit as the frequency falls)"
        )
    return 0.0, math.inf


def _around_optimum(ratio, limits, highest):
    """Return bounds of the logarithms of tuning and damping ratio around the best grid point."""
    closed = exact_optimum(ratio)
    factors = np.geomspace(NARROW * math.sqrt(ratio), WIDE, STEPS)
    tunings = np.log(closed.frequency) + np.concatenate([-factors[::-1], [0.0], factors])
    dampings = np.log(closed.damping_ratio * DAMPINGS)
    if limits != (0.0, math.inf):
        tunings = np.union1d(tunings, np.log(np.linspace(*limits, PLACES)))
        dampings = np.union1d(dampings, np.log(BAND_DAMPINGS))
    heights = [[highest(f, z) for z in dampings] for f in tunings]
    i, j = np.unravel_index(np.argmin(heights), (len(tunings), len(dampings)))
    return _neighbours(tunings, i), _neighbours(dampings, j)


def _neighbours(values, place):
    return values[max(place - 2, 0)], values[min(place + 2, len(values) - 1)]
