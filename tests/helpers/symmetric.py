"""Converged orbits and a central difference of high order, for tests of derivatives."""

from dataclasses import replace

import numpy as np
from references.masri_caughey import flight_with_speed

from impact_damper.model.packed import pack
from impact_damper.orbits.shooting import shoot

# Coefficients of a central difference of order 8.
CENTRAL = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}


def converged(p, state, phase, symmetric):
    """Return the orbit of period 1 near a state, converged up to rounding errors."""
    for _ in range(12):
        orbit = shoot(p, state, 1, phase, symmetric=symmetric)
        n = orbit.active
        change = np.linalg.solve(np.eye(n) - orbit.matrix[:n, :n], orbit.defects[0, :n])
        state = state + (change if n == 4 else np.tile(change, 2))
        if np.max(np.abs(change)) < 1e-13:
            break
    orbit = shoot(p, state, 1, phase, symmetric=symmetric)
    assert orbit.converged
    return orbit


def linear_orbit(oscillator, damper, frequency, ratio):
    """Return the symmetric orbit near Masri and Caughey's motion between rigid walls."""
    linear = replace(oscillator, cubic=0.0)
    clearance, phase, state = flight_with_speed(linear, damper, frequency, ratio)
    damper = replace(damper, clearance=clearance)
    for factor in np.linspace(0, 1, 6):
        changed = replace(oscillator, cubic=factor * oscillator.cubic)
        orbit = converged(pack(changed, damper, frequency), state, phase, True)
        state = orbit.state
    return orbit
