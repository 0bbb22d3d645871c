"""Errors of the kernels' last states and contact counts against the 80-bit reference.

The kernels are the package's integrators, for one motion and for sixteen motions side by side. A
start is a random initial state of a random system, see `starts`.

    PYTHONPATH=src:tests python -m references.extended.agreement

prints a table. Its columns are the number of starts, the number of starts for which the kernel
cannot know the number of contacts (`Agreement.apart`), how many of these differ in this number,
and, for the other starts, the median, the 99 % quantile and the maximum of the error divided by
growth and tolerance.
"""

import functools
from typing import NamedTuple

import numpy as np

from impact_damper.kernel import batch
from impact_damper.kernel.single import side_of, workspace
from impact_damper.kernel.tangents import advance
from references import extended
from references.extended.starts import KINDS, draw

SEED = 4
COUNT = 600  # starts of each kind
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
    """Return the same as `scalar`, computed sixteen motions at a time."""
    states, contacts = starts.states.copy(), np.empty(len(starts.states), int)
    sides = np.array([side_of(p, y) for p, y in zip(starts.parameters, states, strict=True)])
    ends = starts.times[:, -1].copy()
    batch.advance(starts.parameters, states, sides, starts.starts, ends, tolerance, contacts)
    return states, contacts


# The kernels under test, as functions of `Starts` and the tolerance.
KERNELS = {"scalar": scalar, "lanes": side_by_side}


class Agreement(NamedTuple):
    """Errors of a kernel for the starts of one kind: arrays of shape (m,).

    Attributes
    ----------
    error : array
        Largest error of a component of the last state, divided by growth and tolerance. The growth
        (`Run.growth`) is the factor by which an error in the worst direction at the worst instant
        grows until the end. The components are not weighted, and the error is not divided by the
        size of the state, although the kernels' tolerance is relative to a state above 1.
    differs : array of bool
        Whether the number of contacts differs.
    apart : array of bool
        Whether an extremum of Z2, or the last Z2, lies closer to a wall than the tolerance times
        the growth of an error until then. In this case the kernel cannot decide whether the loose
        mass touches the wall. Since the wall turns the loose mass back in one case and not in the
        other, the growth of an error in one case says nothing about the other.
    """

    error: np.ndarray
    differs: np.ndarray
    apart: np.ndarray


@functools.cache
def starts_and_reference(kind):
    """Return the starts of a kind and their reference motions."""
    starts = draw(kind, COUNT, SEED)
    return starts, extended.run_many(*starts)


def agreement(kernel, kind, tolerance):
    """Return the `Agreement` of a kernel of `KERNELS` over all starts of a kind."""
    starts, reference = starts_and_reference(kind)
    states, contacts = KERNELS[kernel](starts, tolerance)
    error = np.max(np.abs(states - reference.states), axis=1) / (reference.growth * tolerance)
    return Agreement(error.astype(float), contacts != reference.begun, reference.margin < tolerance)


def describe(kind, index):
    """Return a start as text, exact to the last bit."""
    starts, reference = starts_and_reference(kind)
    p, y = (", ".join(float(x).hex() for x in part[index]) for part in starts[:2])
    start, end = float(starts.starts[index]).hex(), float(starts.times[index, -1]).hex()
    return (
        f"{kind}, seed {SEED}, index {index}: p = [{p}], y = [{y}], from {start} to {end}; "
        f"{reference.begun[index]} contacts, growth {reference.growth[index]:.3g}"
    )


if __name__ == "__main__":
    print("kernel  kind              tolerance  starts  apart  differ   50 %     99 %      100 %")
    for kernel in KERNELS:
        for kind in KINDS:
            for tolerance in TOLERANCES:
                error, differs, apart = agreement(kernel, kind, tolerance)
                counts = f"{len(error):6d} {np.sum(apart):6d} {np.sum(apart & differs):6d}"
                median, most, all_ = np.percentile(error[~apart], [50, 99, 100])
                print(f"{kernel:7s} {kind:17s} {tolerance:8.0e}  {counts}", end="  ")
                print(f"{median:.1e}  {most:.1e}  {all_:.1e}")
