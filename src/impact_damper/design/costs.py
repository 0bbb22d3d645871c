"""Costs of a motion with a damper: impacts, forces, losses, and the pressure of contacts."""

import numpy as np

from impact_damper.kernel.equation import forcing_amplitude, spring
from impact_damper.kernel.single import side_of
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
from impact_damper.motions.traces import states_at, trace

# If the first state is in a contact, the next flight is sought within PATIENCE forcing cycles.
PATIENCE = 2


def measured_costs(p, y, begin, periods) -> dict:
    """Return the dimensionless costs of a motion over a number of forcing cycles.

    If the state y at the time `begin` is in a contact, the cycles begin in the next flight. Rates,
    forces and powers are NaN if the motion escapes over the barrier of a softening spring. Forces
    and powers are divided by the primary mass. On a moving base the acceleration is absolute; the
    absolute displacement is NaN otherwise.
    """
    begin, y = _in_flight(p, y, begin)
    time = periods * 2 * np.pi / p[FREQUENCY]
    panels = sampled(p, y, begin, begin + time, POLISH_TOLERANCE)
    if np.isnan(panels.states[-1, -1, 0]):
        time = np.nan
    wall, (x, v) = panels.wall[:, None], np.moveaxis(panels.states, -1, 0)[:2]
    depth, rate = penetration(p, panels.states, wall)
    contact = wall_force(p, depth, rate)
    # `py_func` is the Python function of a compiled function; it accepts arrays.
    external = forcing_amplitude.py_func(p) * np.cos(p[FREQUENCY] * panels.times)
    free = (1 - p[BASE]) * external - p[DAMPING] * v - spring.py_func(p, x)
    absolute = largest(x + base_displacement(p, panels.times)) if p[BASE] else np.nan
    _, start, end, approach, _ = panels.log.T
    whole = np.isfinite(end) & (start > panels.times[0, 0])
    return {
        "impact_rate": np.sum(whole) / time,
        "impact_speed": np.max(np.abs(approach[whole]), initial=0.0),
        "contact_force": largest(contact),
        "penetration": largest(depth),
        "largest_acceleration": largest(free - wall * contact),
        "absolute_displacement": absolute,
        "impact_power": np.sum(integrals(panels, p[DASHPOT] * rate**2)) / time,
    }


def pressure_costs(machine, damper, contact, speed) -> tuple[float, str]:
    """Return the pressure (Pa) of an elastic impact by Hertz's theory, and whether walls yield.

    `contact` is a HertzContact or None, and `speed` the largest speed of impact, m/s.
    """
    if contact is None:
        return np.nan, "unknown"
    mass = machine.mass * damper.mass / (machine.mass + damper.mass)
    pressure = contact.pressure(contact.impact(speed, mass).force if speed > 0 else 0.0)
    return pressure, contact.yields(pressure)


def _in_flight(p, y, begin):
    """Return a time at which the loose mass is in flight, and the state at this time.

    If y is in a contact, the time is the middle of the next flight. If the contact does not end
    within PATIENCE, `begin` and y are returned.
    """
    if side_of(p, y) == 0:
        return begin, y
    end = begin + PATIENCE * 2 * np.pi / p[FREQUENCY]
    _, log = trace(p, y, begin, [end], POLISH_TOLERANCE)
    if not np.isfinite(log[0, 2]):
        return begin, y
    following = log[1, 1] if len(log) > 1 else log[0, 2] + np.pi / p[FREQUENCY]
    middle = (log[0, 2] + following) / 2
    states = states_at(p, y, begin, [middle], POLISH_TOLERANCE)
    return middle, states[-1]
