"""Costs of a motion with a damper: impacts, forces, losses, noise, and the pressure of contacts.

The force of a wall per unit of primary mass is f = r1 q + D q', with the penetration q, the contact
stiffness r1 and the dashpot coefficient D. Over a period of the motion,

    work of the external force = losses in the machine's dashpot, in contacts and by friction.

The measure of noise is n <J^2>, the number n of impacts per unit of time times the mean square of
their impulses J. By Campbell's theorem this is the two-sided spectral density of the force of
impacts at random times, for frequencies between n and the inverse of the duration of an impact
(S. O. Rice, Bell System Technical Journal 23, 1944, section 1.5).

Time is divided at the beginnings and ends of contacts, and further into panels, in which a motion
is represented by its states at the Chebyshev nodes, to about twelve digits (L. N. Trefethen,
Spectral Methods in MATLAB, 2000, chapters 6 and 12).
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from impact_damper.kernel.equation import energy, forcing_amplitude, spring, spring_slope
from impact_damper.kernel.single import side_of
from impact_damper.model.packed import (
    BASE,
    CLEARANCE,
    CONTACT_STIFFNESS,
    DAMPING,
    DASHPOT,
    FREQUENCY,
    FRICTION,
    INVERSE_MASS_RATIO,
)
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.motions.traces import states_at, trace

# Nodes of a panel, scaled to [-1, 1]; matrix that maps values at the nodes to coefficients of
# Chebyshev polynomials; weights of the rule of Clenshaw and Curtis.
NODES = -np.cos(np.pi * np.arange(14) / 13)
COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(NODES, len(NODES) - 1))
WEIGHTS = [0.0 if k % 2 else 2 / (1 - k**2) for k in range(len(NODES))] @ COEFFICIENTS
# FINE maps values at the nodes to values at 33 points. The largest modulus in a panel exceeds the
# largest of these 33 moduli by a fraction of less than MISSED.
FINE = chebyshev.chebvander(np.linspace(-1, 1, 33), len(NODES) - 1) @ COEFFICIENTS
MISSED = 0.01
# The fastest oscillation of the motion turns by at most this angle (radian) in a panel.
LONGEST_ANGLE = 2.0
# States in a forcing cycle from which the largest displacement is estimated.
SAMPLES = 32
# If the first state is in a contact, the next flight is sought within PATIENCE forcing cycles.
PATIENCE = 2


class Panels(NamedTuple):
    """A motion in n panels.

    `log` has a row for each contact: wall, times of its beginning and end, relative velocity at
    both. `lengths`, shape (n,), and `times`, shape (n, nodes), are dimensionless; `states` are
    those at the nodes, NaN after an escape. `contact`, shape (n,), is the row of the log or -1 in
    flight, and `wall` is -1, 1, or 0 in flight.
    """

    log: np.ndarray
    lengths: np.ndarray
    times: np.ndarray
    states: np.ndarray
    contact: np.ndarray
    wall: np.ndarray


def measured_costs(p, y, begin, periods) -> dict:
    """Return the dimensionless costs of a motion over a number of forcing cycles.

    If the state y at the time `begin` is in a contact, the cycles begin in the next flight. Rates,
    forces and powers are NaN if the motion escapes over the barrier of a softening spring. Forces
    and powers are divided by the primary mass.
    """
    begin, y = _in_flight(p, y, begin)
    time = periods * 2 * np.pi / p[FREQUENCY]
    panels = sampled(p, y, begin, begin + time)
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


def sampled(p, state, begin, end) -> Panels:
    """Run a motion from a state at the time `begin` and return its panels."""
    rough = np.linspace(begin, end, int(SAMPLES * (end - begin) * p[FREQUENCY] / (2 * np.pi)) + 2)
    states, log = trace(p, state, begin, rough, POLISH_TOLERANCE)
    # The edges are alternately beginnings and ends of contacts, so every second interval is a
    # flight.
    ends = np.where(np.isfinite(log[:, 2]), log[:, 2], end)
    edges = np.concatenate([[begin], np.column_stack([log[:, 1], ends]).ravel(), [end]])
    walls = np.zeros(len(edges) - 1)
    walls[1::2] = log[:, 0]
    steepest = np.nanmax(np.abs(spring_slope.py_func(p, np.append(states[:, 0], 0.0))))
    fastest = np.sqrt(steepest) + p[FREQUENCY]
    contact = np.sqrt(p[CONTACT_STIFFNESS] * (1 + p[INVERSE_MASS_RATIO]))
    rates = np.where(walls, fastest + contact, fastest)
    counts = np.ceil(np.diff(edges) * rates / LONGEST_ANGLE).astype(int)
    interval = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(interval)) - np.repeat(np.cumsum(counts) - counts, counts)
    lengths = (np.diff(edges) / np.maximum(counts, 1))[interval]
    begins = edges[interval] + place * lengths
    times = begins[:, None] + lengths[:, None] * (NODES + 1) / 2
    states = states_at(p, state, begin, times.ravel(), POLISH_TOLERANCE)
    return Panels(
        log,
        lengths,
        times,
        states.reshape(*times.shape, 4),
        np.where(interval % 2, interval // 2, -1),
        walls[interval],
    )


def integrals(panels, values):
    """Return the integral over each panel of a function with `values` at the nodes."""
    return values @ WEIGHTS * panels.lengths / 2


def largest(values) -> float:
    """Return the largest modulus of a function with `values` at the nodes; 0 without panels."""
    if len(values) == 0:
        return 0.0
    fine = np.max(np.abs(values @ FINE.T), axis=1)
    best = np.max(fine)
    for panel in values[fine > (1 - MISSED) * best]:
        series = COEFFICIENTS @ panel
        roots = chebyshev.chebroots(chebyshev.chebder(series))
        inside = roots.real[(np.abs(roots.imag) < 1e-6) & (np.abs(roots.real) < 1)]
        best = max(best, np.max(np.abs(chebyshev.chebval(inside, series)), initial=0.0))
    return float(best)


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


def _penetration(p, panels):
    """Return penetration and its time derivative at the nodes of panels, both 0 in flight."""
    wall = panels.wall[:, None]
    depth = np.where(wall, wall * panels.states[..., 2] - p[CLEARANCE], 0.0)
    return depth, wall * panels.states[..., 3]


def _impacts(p, panels, time):
    """Return impulses and losses of whole contacts, and rate and speed of impacts."""
    depth, rate = _penetration(p, panels)
    force = p[CONTACT_STIFFNESS] * depth + p[DASHPOT] * rate
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
    depth, rate = _penetration(p, panels)
    contact = p[CONTACT_STIFFNESS] * depth + p[DASHPOT] * rate
    x, v = panels.states[..., 0], panels.states[..., 1]
    # `py_func` is the Python function of a compiled function; it accepts arrays.
    external = forcing_amplitude.py_func(p) * np.cos(p[FREQUENCY] * panels.times)
    acceleration = external - p[DAMPING] * v - spring.py_func(p, x)
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
        "force_power": work,
        "impact_power": lost,
        "power_error": (work - damped - lost - stored) / (damped + lost),
    }
