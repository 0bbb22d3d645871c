"""Motions sampled at chosen times, and quadrature over them."""

import numpy as np

from impact_damper.motions import records


def sample(p, state, start, times, tolerance=1e-14):
    """States at increasing times, and contacts as rows of wall, beginning, end, Z2' at both."""
    states, log = np.empty((len(times), 4)), np.empty((4096, 5))
    count = records.trace(
        p, np.array(state, float), float(start), np.array(times, float), tolerance, states, log
    )
    return states, log[:count]


def gauss(breaks, longest=0.1, order=12):
    """Nodes and weights that are spectrally accurate on functions smooth between the breaks."""
    x, w = np.polynomial.legendre.leggauss(order)
    nodes, weights = [], []
    for left, right in zip(breaks[:-1], breaks[1:], strict=True):
        edges = np.linspace(left, right, int(np.ceil((right - left) / longest)) + 1)
        half = np.diff(edges)[:, None] / 2
        nodes.append((edges[:-1, None] + half * (1 + x)).ravel())
        weights.append((half * w).ravel())
    return np.concatenate(nodes), np.concatenate(weights)
