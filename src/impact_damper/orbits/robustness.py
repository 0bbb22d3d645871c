"""Robustness of attractors against shocks and in finite times.

*Convergence time*, *finite-time basin stability* and *minimal critical shock* are named as by
Attractors.jl, version 2 (StabilityQuantifiersAccumulator).
"""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from impact_damper.motions.attractors import orbit_states

# The smallest shock is looked for among SHOCKS shocks of one sign, then between neighbours, in
# so many parts.
SHOCKS = (256, 64, 64, 64)


class Labelled(NamedTuple):
    """Labels of states and cycles until these were known, (m, n), with records of attractors.

    `label` returns both for further states (k, 4).
    """

    labels: np.ndarray
    periods: np.ndarray
    records: np.ndarray
    label: Callable


def robustness(p, found, phase, widest, shock, within) -> dict:
    """Return the variables of the robustness of attractors; shocks are changes of Z1'."""
    rows = []
    for index, record in enumerate(found.records):
        own = found.labels == index
        states = orbit_states(p, record, phase)

        def after(shocks, states=states, index=index):
            """Return which shocks lead away, and the cycles until this is known."""
            pushed = np.repeat(states, len(shocks), axis=0)
            pushed[:, 1::2] += np.tile(shocks, len(states))[:, None]
            labels, periods = found.label(pushed)
            shape = len(states), len(shocks)
            leaves = np.any(labels.reshape(shape) != index, axis=0)
            return leaves, np.max(periods.reshape(shape), axis=0)

        returned = np.nan
        if shock is not None:
            leaves, periods = after(np.array([-shock, shock]))
            returned = np.inf if leaves.any() else np.max(periods)
        critical = min(_critical(sign, after, widest) for sign in (-1, 1))
        times = found.periods[own]
        rows.append(
            (np.median(times), np.mean(own & (found.periods <= within)), critical, returned)
        )
    names = ("attractor_time", "attractor_within", "attractor_shock", "attractor_return")
    return dict(zip(names, np.reshape(rows, (-1, 4)).T, strict=True))


def _critical(sign, after, widest):
    """Return the smallest shock of a sign after which a motion leaves an attractor, or infinity."""
    low, high = 0.0, widest
    for parts in SHOCKS:
        shocks = np.linspace(low, high, parts + 1)
        leaves = after(sign * shocks[1:])[0]
        if not leaves.any():
            return np.inf
        k = int(np.argmax(leaves))
        low, high = shocks[k], shocks[k + 1]
    return high
