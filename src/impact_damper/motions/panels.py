"""Motions in panels: integrals, largest values and contact forces.

A panel is a short interval of time. Each flight and each contact is divided into panels. In a panel
a polynomial through the states at Chebyshev nodes represents the motion to about twelve digits
(L. N. Trefethen, Spectral Methods in MATLAB, 2000, chapters 6 and 12).
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from impact_damper.kernel.equation import forcing_amplitude, spring_slope
from impact_damper.model.packed import (
    BASE,
    CLEARANCE,
    CONTACT_STIFFNESS,
    DASHPOT,
    FREQUENCY,
    INVERSE_MASS_RATIO,
)
from impact_damper.motions.traces import states_at, trace

# The time in a panel is scaled to [-1, 1]. NODES: Chebyshev nodes. COEFFICIENTS: matrix that turns
# values at the nodes into Chebyshev coefficients. WEIGHTS: weights of Clenshaw-Curtis quadrature.
NODES = -np.cos(np.pi * np.arange(14) / 13)
COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(NODES, len(NODES) - 1))
WEIGHTS = [0.0 if k % 2 else 2 / (1 - k**2) for k in range(len(NODES))] @ COEFFICIENTS
# Search for the largest modulus in a panel. POINTS: points that are tried first. NEWTON: steps of
# Newton's method from the best of these points. SLOPE: matrix that turns the Chebyshev coefficients
# of a polynomial into the coefficients of its derivative.
POINTS, NEWTON = np.linspace(-1, 1, 33), 5
SLOPE = np.vstack([chebyshev.chebder(np.eye(len(NODES))), np.zeros(len(NODES))])
# Largest phase, in radians, by which the fastest oscillation of a motion advances in one panel.
LONGEST_ANGLE = 2.0
# Largest number of contacts that are divided into panels at once, to save memory.
PIECE = 100_000
# Number of samples in a forcing cycle, from which the spring's largest stiffness is estimated.
SAMPLES = 32


class Panels(NamedTuple):
    """A motion, divided into n panels.

    A row of `log` is a contact: wall, begin, end, Z2' at begin, Z2' at end. `lengths` (n,) are the
    durations of the panels. `times` (n, nodes) and `states` (n, nodes, 4) are given at the nodes of
    each panel; after an escape `states` are NaN. `contact` (n,) is the row of the panel's contact
    in `log`, or -1 in flight. `wall` (n,) is the wall in contact, -1 or 1, or 0 in flight.
    """

    log: np.ndarray
    lengths: np.ndarray
    times: np.ndarray
    states: np.ndarray
    contact: np.ndarray
    wall: np.ndarray


def sampled(p, state, begin, end, tolerance) -> Panels:
    """Run a motion from a state, from time `begin` to time `end`; return the motion's panels."""
    rough = np.linspace(begin, end, int(SAMPLES * (end - begin) * p[FREQUENCY] / (2 * np.pi)) + 2)
    course = trace(p, state, begin, rough, tolerance)
    return _divided(p, state, (begin, end), course, tolerance, flights=True)


def contact_forces(p, state, span, course, tolerance):
    """Return the largest force in each contact of a motion, divided by the primary mass.

    `span` holds the times at which the motion begins and ends. `course` is the result of `trace`.
    The motion is run again with the steps of `trace`, so even a chaotic motion repeats itself.
    """
    states, log = course
    forces = np.zeros(len(log))
    for first in range(0, len(log), PIECE):
        part = states, log[first : first + PIECE]
        panels = _divided(p, state, span, part, tolerance, flights=False)
        pushes = wall_force(p, *penetration(p, panels.states, panels.wall[:, None]))
        np.maximum.at(forces[first:], panels.contact, peaks(pushes))
    return forces


def _divided(p, state, span, course, tolerance, flights):
    (begin, end), (states, log) = span, course
    # The edges are `begin`, both ends of each contact, and `end`. Flights and contacts alternate.
    ends = np.where(np.isfinite(log[:, 2]), log[:, 2], end)
    edges = np.concatenate([[begin], np.column_stack([log[:, 1], ends]).ravel(), [end]])
    walls = np.zeros(len(edges) - 1)
    walls[1::2] = log[:, 0]
    steepest = np.nanmax(np.abs(spring_slope.py_func(p, np.append(states[:, 0], 0.0))))
    fastest = np.sqrt(steepest) + p[FREQUENCY]
    contact = np.sqrt(p[CONTACT_STIFFNESS] * (1 + p[INVERSE_MASS_RATIO]))
    rates = np.where(walls, fastest + contact, fastest if flights else 0.0)
    counts = np.ceil(np.diff(edges) * rates / LONGEST_ANGLE).astype(int)
    interval = np.repeat(np.arange(len(counts)), counts)
    place = np.arange(len(interval)) - np.repeat(np.cumsum(counts) - counts, counts)
    lengths = (np.diff(edges) / np.maximum(counts, 1))[interval]
    begins = edges[interval] + place * lengths
    times = begins[:, None] + lengths[:, None] * (NODES + 1) / 2
    states = states_at(p, state, begin, times.ravel(), tolerance)
    return Panels(
        log,
        lengths,
        times,
        states.reshape(*times.shape, 4),
        np.where(interval % 2, interval // 2, -1),
        walls[interval],
    )


def integrals(panels, values):
    """Return the integral of a function over each panel, from its `values` at the nodes."""
    return values @ WEIGHTS * panels.lengths / 2


def peaks(values):
    """Return the largest modulus of a function in each panel, from its `values` at the nodes."""
    series = values @ COEFFICIENTS.T

    def at(points, coefficients):
        return np.sum(chebyshev.chebvander(points, len(NODES) - 1) * coefficients, axis=1)

    moduli = np.abs(series @ chebyshev.chebvander(POINTS, len(NODES) - 1).T)
    best = point = POINTS[np.argmax(moduli, axis=1)]
    slope = series @ SLOPE.T
    reach = POINTS[1] - POINTS[0]
    for _ in range(NEWTON):
        bend = at(point, slope @ SLOPE.T)
        move = np.divide(-at(point, slope), bend, out=np.zeros_like(bend), where=bend != 0)
        point = np.clip(point + move, np.maximum(best - reach, -1), np.minimum(best + reach, 1))
    return np.maximum(np.max(moduli, axis=1), np.abs(at(point, series)))


def largest(values) -> float:
    """Return a function's largest modulus, from its `values` at nodes; 0 if there are no panels."""
    return float(np.max(peaks(values), initial=0.0))


def base_displacement(p, times):
    """Return (A/W^2) cos(W T), the displacement of a moving base with the forcing A cos(W T)."""
    amplitude = forcing_amplitude.py_func(p) / p[FREQUENCY] ** 2
    return p[BASE] * amplitude * np.cos(p[FREQUENCY] * times)


def penetration(p, states, wall):
    """Return the depth of the loose mass in a wall (-1 or 1) and its rate. In flight both are 0."""
    return np.where(wall, wall * states[..., 2] - p[CLEARANCE], 0.0), wall * states[..., 3]


def wall_force(p, depth, rate):
    """Return the force of a wall on the loose mass, divided by the primary mass."""
    return p[CONTACT_STIFFNESS] * depth + p[DASHPOT] * rate
