"""A motion sampled such that integrals and maxima of smooth functions of the motion are accurate.

Time is divided at the beginnings and ends of contacts, and further into short intervals called
panels. In each panel the motion is represented by its states at the Chebyshev nodes. The polynomial
through these states is accurate to about twelve digits. (L. N. Trefethen, Spectral Methods in
MATLAB, 2000, chapters 6 and 12.)

Z1 is the displacement of the primary mass and Z2 its displacement relative to the loose mass.
"""

from typing import NamedTuple

import numpy as np
from numpy.polynomial import chebyshev

from impact_damper.kernel.equation import spring_slope
from impact_damper.model.packed import CONTACT_STIFFNESS, FREQUENCY, INVERSE_MASS_RATIO
from impact_damper.motions.strobe_map import POLISH_TOLERANCE
from impact_damper.motions.traces import trace

# NODES: nodes of a panel, scaled to [-1, 1].
# COEFFICIENTS: matrix that maps values at the nodes to coefficients of Chebyshev polynomials.
# _INTEGRALS: integral of each Chebyshev polynomial over [-1, 1].
# WEIGHTS: weights of the values at the nodes in an integral (rule of Clenshaw and Curtis).
NODES = -np.cos(np.pi * np.arange(14) / 13)
COEFFICIENTS = np.linalg.inv(chebyshev.chebvander(NODES, len(NODES) - 1))
_INTEGRALS = [0.0 if k % 2 else 2 / (1 - k**2) for k in range(len(NODES))]
WEIGHTS = _INTEGRALS @ COEFFICIENTS
# FINE: matrix that maps values at the nodes to values at 33 points.
# MISSED: the largest modulus in a panel exceeds the largest of these 33 moduli by less than this
#     fraction. The exact maximum is therefore searched for only in panels with a modulus above
#     1 - MISSED times the largest of the moduli in all panels.
FINE = chebyshev.chebvander(np.linspace(-1, 1, 33), len(NODES) - 1) @ COEFFICIENTS
MISSED = 0.01
# The fastest oscillation of the motion turns by at most this angle (radian) in a panel.
LONGEST_ANGLE = 2.0
# SAMPLES: number of states in a forcing cycle from which the largest |Z1| is estimated.
# FIRST_LOG: number of contacts for which the array of contacts has room at first.
SAMPLES = 32
FIRST_LOG = 256


class Panels(NamedTuple):
    """A motion in panels.

    Attributes
    ----------
    log : numpy.ndarray, shape (contacts, 5)
        One row for each contact, from `traces.trace`: wall, times of its beginning and end, Z2' at
        both.
    lengths : numpy.ndarray, shape (panels,)
        Lengths of the panels in units of T.
    times : numpy.ndarray, shape (panels, nodes)
        Times of the nodes.
    states : numpy.ndarray, shape (panels, nodes, 4)
        Z1, Z1', Z2, Z2'; NaN after an escape.
    contact : numpy.ndarray of int, shape (panels,)
        Index of the contact in the log, or -1 in flight.
    wall : numpy.ndarray, shape (panels,)
        Wall in contact, -1 or 1, or 0 in flight.
    """

    log: np.ndarray
    lengths: np.ndarray
    times: np.ndarray
    states: np.ndarray
    contact: np.ndarray
    wall: np.ndarray


def sampled(p, state, begin, end) -> Panels:
    """Run a motion and return its panels.

    Parameters
    ----------
    p : array, shape (packed.COUNT,)
        Packed parameters.
    state : array, shape (4,)
        State at the time `begin`.
    begin, end : float
        Dimensionless times.
    """
    rough = np.linspace(begin, end, int(SAMPLES * (end - begin) * p[FREQUENCY] / (2 * np.pi)) + 2)
    states, log = logged(p, state, begin, rough)
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
    states, _ = logged(p, state, begin, times.ravel(), len(log))
    return Panels(
        log,
        lengths,
        times,
        states.reshape(*times.shape, 4),
        np.where(interval % 2, interval // 2, -1),
        walls[interval],
    )


def logged(p, state, begin, times, room=FIRST_LOG):
    """Return the states of a motion at given times, shape (n, 4), and the log of its contacts.

    The log is described in `Panels`. `room` is the number of rows of the log at first. If there are
    more contacts, the motion is integrated again with a longer log.
    """
    states = np.empty((len(times), 4))
    while True:
        log = np.empty((room, 5))
        count = trace(p, np.array(state), begin, times, POLISH_TOLERANCE, states, log)
        if count <= room:
            return states, log[:count]
        room = count


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
