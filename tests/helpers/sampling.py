"""States of a motion at chosen times, and Gauss quadrature between its contacts."""

import numpy as np

from impact_damper.motions import strobe_map, traces


def sample(p, state, start, times, tolerance=1e-14):
    """Run the kernel from the time `start` through increasing `times`.

    Return the states, shape (n, 4), and the contacts, shape (k, 5): wall, begin, end, Z2' at the
    begin, Z2' at the end.
    """
    return traces.trace(p, state, start, times, tolerance)


def flow_map(p, y, begin, periods, half, tolerance):
    """Return the state after `strobe_map.flow`, its derivative by y, and the time in contact."""
    state, tangents = y.copy(), np.eye(4)
    _, touching = strobe_map.flow(p, state, tangents, begin, periods, half, tolerance)
    return state, tangents.T.copy(), touching


def gauss(breaks, longest=0.1, order=12):
    """Return nodes and weights of Gauss-Legendre quadrature from the first to the last break."""
    x, w = np.polynomial.legendre.leggauss(order)
    nodes, weights = [], []
    for left, right in zip(breaks[:-1], breaks[1:], strict=True):
        edges = np.linspace(left, right, int(np.ceil((right - left) / longest)) + 1)
        half = np.diff(edges)[:, None] / 2
        nodes.append((edges[:-1, None] + half * (1 + x)).ravel())
        weights.append((half * w).ravel())
    return np.concatenate(nodes), np.concatenate(weights)
