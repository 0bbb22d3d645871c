"""How far the kernels' last states and contact counts are from the 80-bit reference.

    PYTHONPATH=src:tests python -m references.extended.agreement

prints a table: starts, those counted apart, those among them whose count differs, and of the
others median, 99 % and largest error, divided by growth and tolerance.
"""

import functools
from typing import NamedTuple

import numpy as np

from impact_damper.kernel import batch
from impact_damper.kernel.single import advance, side_of, workspace
from references import extended
from references.extended.starts import KINDS, draw

SEED = 4
COUNT = 840  # of each kind, 13 440 in all
TOLERANCES = (1e-6, 1e-9, 1e-12)


def scalar(starts, tolerance):
    """Last states (m, 4) and contacts begun (m,), one motion at a time."""
    states, contacts = starts.states.copy(), np.empty(len(starts.states), int)
    none, work = np.empty((0, 4)), workspace()
    for i, (p, y) in enumerate(zip(starts.parameters, states, strict=True)):
        start, end = starts.starts[i], starts.times[i, -1]
        _, contacts[i], _ = advance(p, y, none, side_of(p, y), start, end, tolerance, work)
    return states, contacts


def side_by_side(starts, tolerance):
    """The same, sixteen motions at a time."""
    states, contacts = starts.states.copy(), np.empty(len(starts.states), int)
    sides = np.array([side_of(p, y) for p, y in zip(starts.parameters, states, strict=True)])
    ends = starts.times[:, -1].copy()
    batch.advance(starts.parameters, states, sides, starts.starts, ends, tolerance, contacts)
    return states, contacts


# What runs all starts of a kind: a function of `Starts` and the tolerance, as `scalar`.
KERNELS = {"scalar": scalar, "lanes": side_by_side}


class Agreement(NamedTuple):
    """For each start of a kind, arrays of shape (m,).

    Attributes
    ----------
    error : array
        Largest error of a component of the last state, over growth and tolerance. The growth is
        the largest norm of the flow's derivative from an instant of the run (start, strobe or
        event) to its end, at least 1, in the norm that belongs to the largest component: what an
        error in the worst direction at the worst instant becomes. No component is weighted and
        nothing is divided by the size of the state, though the kernels' tolerance is relative
        to it where it is above 1.
    differs : array of bool
        Whether the number of contacts differs.
    apart : array of bool
        Whether an extremum of Z2, touching or not, or the last Z2 lies closer to a wall than the
        tolerance times the growth of an error until there. Whether it touches is then not for
        the kernel to tell; and as a stiff wall turns the mass back or does not, the flow's
        derivative on one side says nothing of the other.
    """

    error: np.ndarray
    differs: np.ndarray
    apart: np.ndarray


@functools.cache
def starts_and_reference(kind):
    starts = draw(kind, COUNT, SEED)
    return starts, extended.run_many(*starts)


def agreement(kernel, kind, tolerance):
    """`Agreement` of a kernel of `KERNELS` over all starts of a kind."""
    starts, reference = starts_and_reference(kind)
    states, contacts = KERNELS[kernel](starts, tolerance)
    error = np.max(np.abs(states - reference.states), axis=1) / (reference.growth * tolerance)
    return Agreement(error.astype(float), contacts != reference.begun, reference.margin < tolerance)


def describe(kind, index):
    """A start to the last bit."""
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
