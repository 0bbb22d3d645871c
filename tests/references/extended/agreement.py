"""Errors of the kernels' last states and contact counts against the 80-bit reference.

One kernel computes one motion, the other kernel computes sixteen motions side by side.
"""

import functools
from typing import NamedTuple

import numpy as np

from impact_damper.kernel import batch
from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from references import extended
from references.extended.starts import draw

SEED = 4
COUNT = 300  # starts of each kind
TOLERANCES = (1e-6, 1e-9, 1e-12)


def scalar(starts, tolerance):
    """Return last states (m, 4) and contacts begun (m,), computed one motion at a time."""
    states, contacts = starts.states.copy(), np.empty(len(starts.states), int)
    none, work = np.empty((0, 4)), workspace()
    for i, (p, y) in enumerate(zip(starts.parameters, states, strict=True)):
        start, end = starts.starts[i], starts.times[i, -1]
        _, contacts[i], _ = advance(p, y, none, side_of(p, y), start, end, tolerance, work)
    return states, contacts


def side_by_side(starts, tolerance):
    """Return last states (m, 4) and contacts begun (m,), computed sixteen motions at a time."""
    states, contacts = starts.states.copy(), np.empty(len(starts.states), int)
    sides = np.array([side_of(p, y) for p, y in zip(starts.parameters, states, strict=True)])
    ends = starts.times[:, -1].copy()
    batch.advance(starts.parameters, states, sides, starts.starts, ends, tolerance, contacts)
    return states, contacts


# The kernels under test, as functions of `Starts` and the tolerance.
KERNELS = {"scalar": scalar, "lanes": side_by_side}


class Agreement(NamedTuple):
    """Errors of a kernel for the starts of one kind: arrays of shape (m,).

    `error` is the largest error of the last state, divided by the tolerance and by `Run.growth`.
    `differs` marks a wrong number of contacts. `apart` marks a start with an extremum of Z2 closer
    to a wall than the tolerance times the growth of an error: rounding decides about the contact.
    """

    error: np.ndarray
    differs: np.ndarray
    apart: np.ndarray


@functools.cache
def starts_and_reference(kind):
    """Return the starts of a kind, and the 80-bit `Run` of each start."""
    starts = draw(kind, COUNT, SEED)
    return starts, [extended.run(*each) for each in zip(*starts, strict=True)]


def agreement(kernel, kind, tolerance):
    """Return the `Agreement` of a kernel of `KERNELS` over all starts of a kind."""
    starts, reference = starts_and_reference(kind)
    states, contacts = KERNELS[kernel](starts, tolerance)
    exact = np.array([run.states[-1] for run in reference])
    growth, margin = np.array([(run.growth, run.margin) for run in reference]).T
    error = np.max(np.abs(states - exact), axis=1) / (growth * tolerance)
    begun = np.array([run.begun for run in reference])
    return Agreement(error.astype(float), contacts != begun, margin < tolerance)


def describe(kind, index):
    """Return a start as text, exact to the last bit."""
    starts, reference = starts_and_reference(kind)
    p, y, begin, times = (
        ", ".join(float(x).hex() for x in np.atleast_1d(part[index])) for part in starts
    )
    run = reference[index]
    return (
        f"{kind}, seed {SEED}, index {index}: p = [{p}], y = [{y}], from {begin} through {times}; "
        f"{run.begun} contacts, growth {run.growth:.3g}"
    )
