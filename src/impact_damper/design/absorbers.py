"""Tuned absorbers: their tuning to a machine, and the machine's response in closed form.

Frequencies r are divided by the natural frequency of the machine, and s = r^2. The machine has the
damping ratio z1. The absorber has the mass ratio m, the tuning f (its natural frequency divided by
the machine's) and the damping ratio z. The squared displacement of a linear machine, in the unit
of the table, is g(s) N(s)/D(s) with

    N = (b f^2 - s)^2 + 4 z^2 b^2 f^2 s
    D = [(1 - s)(f^2 - s) - 4 z1 z f s - m f^2 s]^2 + 4 s [z1 (f^2 - s) + z f (1 - s) - m z f s]^2

    excitation                        unit of displacement    g      b
    force F                           F/k                     1      1
    unbalance m_e r_e                 m_e r_e/m1              s^2    1
    displacement A of the base        A                       s^2    1 + m
    acceleration B of the base        B/w1^2                  1      1 + m

m1, k and w1 are mass, stiffness and natural frequency (rad/s) of the machine. A moving base
accelerates both masses, and displacements are relative to the base.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.polynomial import polynomial
from scipy.optimize import minimize_scalar

from impact_damper.data.datasets import flag
from impact_damper.design.task import labelled
from impact_damper.model.machine import TunedAbsorber
from impact_damper.theory.roots import polynomial_roots
from impact_damper.theory.tuned_mass_damper import Tuning, exact_optimum

# Largest imaginary part of a root that is taken as real, divided by the width of the resonance.
REAL = 1e-6
# Grid of the first search for the optimum, around the closed form `exact_optimum`. On each side lie
# STEPS tunings, at logarithmic distances from NARROW sqrt(mass ratio) to WIDE. DAMPINGS multiply
# the damping ratio. A given band adds PLACES tunings and the damping ratios BAND_DAMPINGS.
STEPS, NARROW, WIDE = 10, 0.1, 0.4
DAMPINGS = np.geomspace(0.3, 10, 12)
PLACES = 9
BAND_DAMPINGS = np.geomspace(1e-3, 0.3, 10)
# Tolerances of the logarithms of tuning and damping ratio when the optimum is refined.
TUNING_TOLERANCE, DAMPING_TOLERANCE = 1e-11, 1e-10
COMPETITORS = ("bare", "tuned", "own")
# Force shares (factors of the machine's excitation), from a quarter to four.
SHARES = tuple(2.0 ** (step / 2) for step in range(-4, 5))
DETUNINGS = (-0.1, 0.0, 0.1)


class LinearMachine(NamedTuple):
    """Linear machine: z1, g(s), moving base or not, unit of displacement (m), frequency (Hz)."""

    damping_ratio: float
    forcing: np.ndarray
    based: bool
    unit: float
    natural_frequency: float

    def load(self, mass_ratio) -> float:
        """Return b: on a moving base the absorber passes its own load on to the machine."""
        return 1 + mass_ratio if self.based else 1.0


def absorber_responses(
    machine, mass, frequencies, force_shares=SHARES, *, detunings=DETUNINGS, band=None, own=None
):
    """Return a dataset of displacements (mm) without absorber, with a tuned one, and with `own`.

    `mass` (kg) is the mass of the tuned absorber, `band` (Hz) the range over which it is tuned.
    `force_shares` multiply the excitation. `detunings` are relative changes of the absorber's
    stiffness. Status: exact; one_harmonic (cubic spring); not_possible (no linear stiffness).
    """
    names = COMPETITORS[: 2 if own is None else 3]
    sizes = np.full((len(names), len(detunings), len(frequencies), len(force_shares)), np.nan)
    sizes[0] = response(machine, None, frequencies, force_shares)
    springs = np.full((2, *sizes.shape[:2]), np.nan)
    kind = "one_harmonic" if machine.cubic_stiffness else "exact"
    status, absorbers = [kind] * len(names), {}
    if own is not None:
        absorbers[2] = own
    if not machine.linear_stiffness:
        status[1] = "not_possible"
    else:
        absorbers[1] = exact_absorber(machine, mass, band)
    for row, absorber in absorbers.items():
        for column, detuning in enumerate(detunings):
            built = absorber.detuned(detuning)
            sizes[row, column] = response(machine, built, frequencies, force_shares)
            springs[:, row, column] = built.stiffness, built.damping
    values = {
        "competitor_displacement": 1e3 * sizes,
        "competitor_status": [flag("competitor_status", each) for each in status],
        "absorber_stiffness": springs[0],
        "absorber_damping": springs[1],
    }
    return labelled(
        values,
        competitor=list(names),
        detuning=detunings,
        frequency=frequencies,
        force_share=force_shares,
    )


def exact_absorber(machine, mass, band=None) -> TunedAbsorber:
    """Return the absorber that minimises the largest displacement of the linear machine.

    The cubic stiffness of the machine is ignored. `mass` is in kg and `band` in Hz, by default all
    frequencies. At the optimum the response is equally large at two frequencies: at the two highest
    maxima, or at the highest maximum and an end of the band.
    """
    ratio, linear = mass / machine.mass, linear_machine(machine)
    limits = (0.0, math.inf) if band is None else tuple(f / linear.natural_frequency for f in band)

    def highest(log_tuning, log_damping):
        tuning = Tuning(ratio, math.exp(log_tuning), math.exp(log_damping))
        return maxima(linear, tuning, limits)[1].max()

    def best_tuning(log_damping):
        # At the optimum two maxima cross in a kink. A fit of parabolas would stop too early there.
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


def linear_machine(machine) -> LinearMachine:
    """Return the `LinearMachine` of a machine, whose cubic stiffness is ignored."""
    stiffness, mass = machine.linear_stiffness, machine.mass
    if stiffness == 0:
        raise ValueError(
            "linear_stiffness = 0 N/m: must be greater than 0 N/m for a tuned absorber (the "
            "machine has no natural frequency to tune to)"
        )
    ratio = machine.viscous_damping / (2 * math.sqrt(stiffness * mass))
    force, unbalance = machine.forcing
    forcing = (np.array([0.0, 0.0, 1.0]), unbalance / mass)
    if not unbalance:
        forcing = (np.ones(1), force / stiffness)
    return LinearMachine(ratio, forcing[0], machine.is_based, forcing[1], machine.natural_frequency)


def maxima(linear, tuning, band):
    """Return r and squared displacement of each stationary point in a band and of the band's ends.

    Stationary points are roots of a polynomial in t, with s = 1 + w t and the width w of the
    resonance. In s the roots for a light absorber would lie so close that rounding merges them.
    """
    (mass, f, z), z1 = tuning, linear.damping_ratio
    width = min(math.sqrt(mass) + z1, 1.0)
    s, host, own = np.array([1.0, width]), np.array([0.0, -width]), np.array([f**2 - 1, -width])
    carried = (4 * z1 * z * f + mass * f**2) * s
    real = np.convolve(host, own) - np.append(carried, 0.0)
    imaginary = 2 * (z1 * own + z * f * host - mass * z * f * s)
    load = linear.load(mass)
    passed = np.array([load * f**2 - 1, -width])
    above = np.convolve(passed, passed) + np.append((2 * z * f * load) ** 2 * s, 0.0)
    below = polynomial.polyadd(
        np.convolve(real, real), np.convolve(s, np.convolve(imaginary, imaginary))
    )
    above = np.convolve(above, _composed(linear.forcing, s))
    slope = polynomial.polysub(
        np.convolve(polynomial.polyder(above), below),
        np.convolve(above, polynomial.polyder(below)),
    )
    roots = 1 + width * polynomial.polyroots(slope)
    places = np.sqrt(roots.real[(np.abs(roots.imag) <= REAL * width) & (roots.real > 0)])
    ends = np.array([end for end in band if math.isfinite(end)])
    inside = places[(places > band[0]) & (places < band[1])]
    stationary = np.sort(np.concatenate([ends, inside]))
    return stationary, _squared(linear, tuning, stationary)


def response(machine, absorber, frequencies, force_shares=(1.0,)) -> np.ndarray:
    """Return largest amplitudes (m) at frequencies (Hz), shape (frequencies, force shares).

    Amplitudes are exact for a linear machine. With a cubic spring they are from harmonic balance:
    the largest solution that is stable against folds and below the barrier of a softening spring,
    or infinity without such a solution. Other instabilities and other motions are not found.
    """
    scales = machine.scales
    sizes = np.empty((len(frequencies), len(force_shares)))
    for row, hertz in zip(sizes, frequencies, strict=True):
        oscillator, w = machine.oscillator(), scales.from_si(hertz, "frequency")
        force = oscillator.forcing_amplitude(w)
        stiffness = oscillator.linear_frequency**2 - w**2 + 1j * oscillator.damping * w
        if absorber is not None:
            link = scales.from_si(absorber.stiffness, "stiffness")
            link += 1j * w * scales.from_si(absorber.damping, "damping")
            mass = absorber.mass / machine.mass
            passed = mass * link / (link - mass * w**2)
            stiffness -= w**2 * passed
            force *= abs(1 + oscillator.base * passed)
        row[:] = [_amplitude(oscillator, stiffness, force * share) for share in force_shares]
    return scales.to_si(sizes, "displacement")


def _amplitude(oscillator, stiffness, force):
    """Return the solution a of |stiffness + (3/4) k3 a^2| a = force that `response` describes."""
    hardening = oscillator.hardening
    if hardening == 0:
        return force / abs(stiffness)
    squares = np.sort(
        polynomial_roots(
            [-(force**2), abs(stiffness) ** 2, 2 * hardening * stiffness.real, hardening**2]
        )
    )
    barrier = math.inf
    if hardening < 0:
        barrier = 0.75 * oscillator.linear_frequency**2 / -hardening
    # The middle one of three solutions is unstable.
    stable = squares[::2][squares[::2] < barrier]
    return math.sqrt(stable[-1]) if len(stable) else math.inf


def _squared(linear, tuning, frequency):
    """Return g(s) N(s)/D(s), the squared displacement of a linear machine, at frequencies r."""
    s = np.square(frequency)
    forcing = polynomial.polyval(s, linear.forcing)
    (mass, f, z), z1 = tuning, linear.damping_ratio
    real = (1 - s) * (f**2 - s) - 4 * z1 * z * f * s - mass * f**2 * s
    imaginary = 2 * (z1 * (f**2 - s) + z * f * (1 - s) - mass * z * f * s)
    load = linear.load(mass)
    above = (load * f**2 - s) ** 2 + (2 * z * f * load) ** 2 * s
    return forcing * above / (real**2 + s * imaginary**2)


def _composed(coefficients, inner):
    """Return the coefficients of a polynomial whose argument is the polynomial `inner`."""
    composed = np.zeros(1)
    for coefficient in coefficients[::-1]:
        composed = np.convolve(composed, inner)
        composed[0] += coefficient
    return composed


def _absorber(machine, tuning):
    """Return the absorber in SI units for a machine and a dimensionless `Tuning`."""
    mass = tuning.mass_ratio * machine.mass
    own = 2 * math.pi * linear_machine(machine).natural_frequency * tuning.frequency
    return TunedAbsorber(
        mass=mass, stiffness=mass * own**2, damping=2 * mass * tuning.damping_ratio * own
    )


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
