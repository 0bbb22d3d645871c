"""Costs of a motion with a damper: impacts, forces, losses, and the pressure of contacts."""

import numpy as np

from impact_damper.kernel.equation import forcing_amplitude, spring
from impact_damper.model.packed import BASE, DAMPING, DASHPOT, FREQUENCY
from impact_damper.motions.panels import (
    base_displacement,
    integrals,
    largest,
    penetration,
    sampled,
    wall_force,
)
from impact_damper.motions.strobe_map import POLISH_TOLERANCE


def measured_costs(p, y, begin, periods) -> dict:
    """Return a dictionary of the dimensionless costs of a motion over `periods` forcing cycles.

    `p`: packed parameters. `y`: state at the time `begin`. `impact_rate` and `impact_speed` include
    only contacts begun in these cycles. Accelerations are absolute. After an escape, rates, forces,
    accelerations and powers are NaN. `absolute_displacement` is NaN unless the base moves.
    """
    time = periods * 2 * np.pi / p[FREQUENCY]
    panels = sampled(p, y, begin, begin + time, POLISH_TOLERANCE)
    if np.isnan(panels.states[-1, -1, 0]):
        time = np.nan
    wall, (x, v) = panels.wall[:, None], np.moveaxis(panels.states, -1, 0)[:2]
    depth, rate = penetration(p, panels.states, wall)
    contact = wall_force(p, depth, rate)
    # Python cannot call the compiled `forcing_amplitude` and `spring`, only their `py_func`.
    external = forcing_amplitude.py_func(p) * np.cos(p[FREQUENCY] * panels.times)
    free = (1 - p[BASE]) * external - p[DAMPING] * v - spring.py_func(p, x)
    absolute = largest(x + base_displacement(p, panels.times)) if p[BASE] else np.nan
    begun = panels.log[panels.log[:, 1] > begin]
    return {
        "impact_rate": len(begun) / time,
        "impact_speed": np.max(np.abs(begun[:, 3]), initial=0.0),
        "contact_force": largest(contact),
        "penetration": largest(depth),
        "largest_acceleration": largest(free - wall * contact),
        "absolute_displacement": absolute,
        "impact_power": np.sum(integrals(panels, p[DASHPOT] * rate**2)) / time,
    }


def pressure_costs(machine, damper, contact, speed) -> tuple[float, str]:
    """Return the pressure (Pa) of an elastic impact, and whether the material yields under it.

    The second value is "yes", "no" or "unknown". `contact` is a HertzContact, or None if shape and
    material of the bodies are unknown. `speed` is the largest speed of impact, m/s.
    """
    if contact is None:
        return np.nan, "unknown"
    mass = machine.mass * damper.mass / (machine.mass + damper.mass)
    pressure = contact.pressure(contact.impact(speed, mass).force if speed > 0 else 0.0)
    return pressure, contact.yields(pressure)
