"""The optimum clearance by harmonic balance (7): the clearance at which the amplitude is zero."""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from impact_damper.data.datasets import flag
from impact_damper.model.parameters import beyond_closed_forms
from impact_damper.theory import single_harmonic as balance
from impact_damper.theory.slow_flow import fixed_points, growth_rate, stability

# Largest |a| that is treated as a = 0, in units of the clearance.
ZERO_AMPLITUDE = 1e-6


def _analytical(oscillator, damper, frequency):
    """Return the amplitude a of the smallest stable solution of (7), and `analytical_status`."""
    if damper.restitution != 1:
        return np.nan, "inelastic"
    if beyond_closed_forms(oscillator, damper):
        return np.nan, "unknown"
    try:
        solutions = balance.impacting_solutions(oscillator, damper, frequency)
    except ArithmeticError:
        return np.nan, "unresolved"
    growth = growth_rate(fixed_points(solutions), oscillator, damper, frequency)
    stable = solutions.amplitude[stability(growth) == flag("stability", "stable")]
    return (min(stable, key=abs), "found") if len(stable) else (np.nan, "absent")


def analytical_table(oscillator, dampers, frequency):
    """Return variables: |a| by (7) for dampers of ascending clearance; the clearance for a = 0."""
    found = [_analytical(oscillator, each, frequency) for each in dampers]
    signed, status = np.array([size for size, _ in found]), [name for _, name in found]
    best = np.nan

    def amplitude(clearance):
        return _analytical(oscillator, replace(dampers[0], clearance=clearance), frequency)[0]

    for k in np.flatnonzero(signed[1:] * signed[:-1] < 0):
        clearance = brentq(amplitude, dampers[k].clearance, dampers[k + 1].clearance)
        # The sign also changes at a jump, where another solution becomes the smallest.
        if abs(amplitude(clearance)) < ZERO_AMPLITUDE * clearance:
            best = clearance
    return {
        "analytical_amplitude": np.abs(signed),
        "analytical_status": np.array([flag("analytical_status", each) for each in status]),
        "analytical_optimum": best,
    }
