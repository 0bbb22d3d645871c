"""Robustness of attractors against shocks, and in finite time.

The names *convergence time*, *finite-time basin stability* and *minimal critical shock* come from
Attractors.jl, version 2 (StabilityQuantifiersAccumulator).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from impact_damper.motions.attractors import orbit_states

# Search for the smallest shock of one sign: number of parts into which an interval is divided in
# each round. The next interval is the first part at whose end the shock leads away.
SHOCKS = (256, 64, 64, 64)


class Labelled(NamedTuple):
    """Labels (m, n) of n plane states with m states of the loose mass, and attractors' `records`.

    `periods` (m, n): cycles until a label is known. `label` returns both for more states (k, 4).
    """

    labels: np.ndarray
    periods: np.ndarray
    records: np.ndarray
    label: Callable


def robustness(p, found, phase, widest, shock, within) -> dict:
    """Return the variables of the robustness of attractors; shocks are changes of Z1'."""
    rows = []
    for index, record in enumerate(found.records):
        own, states, returned = found.labels == index, orbit_states(p, record, phase), np.nan
        if shock is not None:
            leaves, periods = _after(found, index, states, np.array([-shock, shock]))
            returned = np.inf if leaves.any() else periods.max()
        critical = min(_critical(found, index, states, most) for most in (-widest, widest))
        share = np.mean(own & (found.periods <= within))
        middle = np.median(found.periods[own]) if own.any() else np.nan
        rows.append((middle, share, critical, returned))
    names = ("attractor_time", "attractor_within", "attractor_shock", "attractor_return")
    return dict(zip(names, np.reshape(rows, (-1, 4)).T, strict=True))


def _after(found, index, states, shocks):
    """Return which shocks to an attractor's states lead away, and cycles until this is known."""
    pushed = np.repeat(states, len(shocks), axis=0)
    pushed[:, 1::2] += np.tile(shocks, len(states))[:, None]
    labels, periods = (each.reshape(len(states), -1) for each in found.label(pushed))
    return np.any(labels != index, axis=0), np.max(periods, axis=0)


def _critical(found, index, states, most):
    """Return the size of the smallest shock up to `most` that leads away, or infinity."""
    low, high = 0.0, most
    for parts in SHOCKS:
        shocks = np.linspace(low, high, parts + 1)
        leaves, _ = _after(found, index, states, shocks[1:])
        if not leaves.any():
            return np.inf
        k = int(np.argmax(leaves))
        low, high = shocks[k], shocks[k + 1]
    return abs(high)
