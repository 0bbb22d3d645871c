"""Costs of a motion with a damper: impacts, forces, losses, noise, and the pressure of contacts.

The force of a wall per unit of primary mass is f = r1 q + D q', with the penetration q, the contact
stiffness r1 and the dashpot coefficient D. Over a period of the motion,

    work of the external force = losses in the machine's dashpot, in contacts and by friction.
"""

import numpy as np

from impact_damper.kernel.equation import energy, forcing_amplitude, spring
from impact_damper.kernel.single import side_of
from impact_damper.model.packed import (
    BASE,
    DAMPING,
    DASHPOT,
    FREQUENCY,
    FRICTION,
    INVERSE_MASS_RATIO,
)
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
    return _impacts(p, panels, time) | _extremes_and_powers(p, panels, time)


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


def _impacts(p, panels, time):
    """Return impulses and losses of whole contacts, and rate and speed of impacts."""
    depth, rate = penetration(p, panels.states, panels.wall[:, None])
    force = wall_force(p, depth, rate)
    impulse, loss = (
        np.bincount(panels.contact + 1, integrals(panels, values), len(panels.log) + 1)[1:]
        for values in (force, p[DASHPOT] * rate**2)
    )
    _, start, end, approach, _ = panels.log.T
    whole = np.isfinite(end) & (start > panels.times[0, 0])
    return {
        "contact_impulse": impulse[whole],
        "contact_loss": loss[whole],
        "impact_rate": np.sum(whole) / time,
        "impact_speed": np.max(np.abs(approach[whole]), initial=0.0),
    }


def _extremes_and_powers(p, panels, time):
    """Return the largest force, penetration and acceleration, mean powers, and their balance."""
    depth, rate = penetration(p, panels.states, panels.wall[:, None])
    contact = wall_force(p, depth, rate)
    x, v = panels.states[..., 0], panels.states[..., 1]
    # `py_func` is the Python function of a compiled function; it accepts arrays.
    external = forcing_amplitude.py_func(p) * np.cos(p[FREQUENCY] * panels.times)
    acceleration = (1 - p[BASE]) * external - p[DAMPING] * v - spring.py_func(p, x)
    w, loose = panels.states[..., 3], 1 / p[INVERSE_MASS_RATIO]
    # On a moving base, the force of inertia acts on the loose mass too.
    supplied = external * (v + p[BASE] * loose * (v - w))
    spent = p[DAMPING] * v**2 + loose * p[FRICTION] * np.abs(w)
    powers = supplied, spent, p[DASHPOT] * rate**2
    work, damped, lost = (np.sum(integrals(panels, each)) / time for each in powers)
    first, last = (energy.py_func(p, panels.states[place, place]) for place in (0, -1))
    stored = (last - first) / time
    return {
        "contact_force": largest(contact),
        "penetration": largest(depth),
        "largest_acceleration": largest(acceleration - panels.wall[:, None] * contact),
        "absolute_displacement": largest(x + base_displacement(p, panels.times))
        if p[BASE]
        else np.nan,
        "force_power": work,
        "impact_power": lost,
        "power_error": (work - damped - lost - stored) / (damped + lost),
    }
