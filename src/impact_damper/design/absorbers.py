"""Tuned absorbers: the tuning of an absorber to a machine, and the response in closed form.

The machine has mass m1, stiffness k, damping c. The absorber has mass m, stiffness ka, damping ca.
w is the angular frequency. Let K = k + i c w - m1 w^2, L = ka + i ca w, q = L/(L - m w^2). A force
of amplitude F moves the machine by F/|K - m w^2 q|. A base whose acceleration has the amplitude A
moves the machine by |m1 + q m| A/|K - m w^2 q|, relative to the base.
"""

import math
from dataclasses import replace
from functools import cache

import numpy as np
from scipy.optimize import differential_evolution

from impact_damper.data.datasets import flag
from impact_damper.design.task import labelled
from impact_damper.model.machine import TunedAbsorber
from impact_damper.theory.roots import polynomial_roots

# An absorber is tuned to lower the largest displacement at POINTS frequencies. Their distance from
# the resonance is at most REACH x the width of the resonance peak. If a band is given, frequencies
# outside the band are left out, and POINTS evenly spaced frequencies in the band are added.
POINTS, REACH = 1001, 8.0
# The optimizer `differential_evolution` searches ln(absorber frequency/machine frequency) within
# the bounds TUNINGS, and ln(damping ratio of the absorber) within the bounds DAMPINGS. TOLERANCE is
# the optimizer's relative tolerance, SEED the seed of its random numbers.
TUNINGS, DAMPINGS, TOLERANCE, SEED = (-1.5, 1.0), (-7.0, 0.7), 1e-7, 1995
COMPETITORS = ("bare", "tuned", "own")
SHARES = tuple(2.0 ** (step / 2) for step in range(-4, 5))  # factors of the excitation, 1/4 to 4
DETUNINGS = (-0.1, 0.0, 0.1)


def absorber_responses(
    machine, mass, frequencies, force_shares=SHARES, *, detunings=DETUNINGS, band=None, own=None
):
    """Return a dataset of displacements (mm) of a machine without absorber, and with two absorbers.

    One absorber is tuned: with its mass `mass` (kg) it gives the lowest peak over `band` (Hz). The
    other is `own`, a `TunedAbsorber` or None. Displacements are at `frequencies` (Hz). The
    excitation is multiplied by each of `force_shares`. An absorber's stiffness is changed by each
    of the fractions `detunings`. Without a linear spring the tuned absorber has displacements NaN.
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
    axes = {"detuning": detunings, "frequency": frequencies, "force_share": force_shares}
    return labelled(values, competitor=list(names), **axes)


@cache
def exact_absorber(machine, mass, band=None) -> TunedAbsorber:
    """Return the absorber that gives the lowest peak over `band` (Hz), if the cubic spring is 0."""
    ratio, linear = mass / machine.mass, replace(machine, cubic_stiffness=0.0)
    frequencies = _frequencies(linear, ratio, band)

    def absorber(log_tuning, log_damping):
        own = 2 * math.pi * linear.natural_frequency * math.exp(log_tuning)
        damping = 2 * mass * math.exp(log_damping) * own
        return TunedAbsorber(mass=mass, stiffness=mass * own**2, damping=damping)

    def highest(logs):
        stiffness, force = _dynamics(linear, absorber(*logs), frequencies)
        return np.max(force / np.abs(stiffness))

    # The function `highest` has a kink at its minimum, so an optimizer must not rely on slopes.
    given = {"rng": SEED, "tol": TOLERANCE, "atol": 0, "polish": False}
    return absorber(*differential_evolution(highest, (TUNINGS, DAMPINGS), **given).x)


def _frequencies(machine, ratio, band):
    critical = 2 * math.sqrt(machine.linear_stiffness * machine.mass)
    width = min(math.sqrt(ratio) + machine.viscous_damping / critical, 1.0)
    ends = 1 + REACH * width * np.array([-1.0, 1.0])
    found = machine.natural_frequency * np.linspace(max(ends[0], 0.1), ends[1], POINTS)
    if band is None:
        return found
    inside = found[(found > band[0]) & (found < band[1])]
    return np.union1d(inside, np.linspace(*band, POINTS))


def response(machine, absorber, frequencies, force_shares=(1.0,)) -> np.ndarray:
    """Return amplitudes (m) at each frequency (Hz), for the excitation times each force share.

    Without a cubic spring the amplitudes are exact. With a cubic spring they are the largest stable
    solutions of the harmonic balance, or infinite if none lies below the barrier of the spring.
    """
    oscillator = machine.oscillator()
    pairs = zip(*_dynamics(machine, absorber, np.asarray(frequencies)), strict=True)
    sizes = [
        [_amplitude(oscillator, stiffness, force * share) for share in force_shares]
        for stiffness, force in pairs
    ]
    return machine.scales.to_si(np.array(sizes), "displacement")


def _dynamics(machine, absorber, frequencies):
    scales, oscillator = machine.scales, machine.oscillator()
    w = scales.from_si(frequencies, "frequency")
    force = oscillator.force + oscillator.unbalance * w**2
    stiffness = oscillator.linear_frequency**2 - w**2 + 1j * oscillator.damping * w
    if absorber is not None:
        link = scales.from_si(absorber.stiffness, "stiffness")
        link = link + 1j * w * scales.from_si(absorber.damping, "damping")
        mass = absorber.mass / machine.mass
        passed = mass * link / (link - mass * w**2)
        stiffness = stiffness - w**2 * passed
        force = force * np.abs(1 + oscillator.base * passed)
    return stiffness, force


def _amplitude(oscillator, stiffness, force):
    hardening = oscillator.hardening
    if hardening == 0:
        return force / abs(stiffness)
    terms = [-(force**2), abs(stiffness) ** 2, 2 * hardening * stiffness.real, hardening**2]
    squares = polynomial_roots(terms)
    barrier = math.inf
    if hardening < 0:
        barrier = 0.75 * oscillator.linear_frequency**2 / -hardening
    stable = squares[::2][squares[::2] < barrier]  # of three solutions the middle one is unstable
    return math.sqrt(stable[-1]) if len(stable) else math.inf
