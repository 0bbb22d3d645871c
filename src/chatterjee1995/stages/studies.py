"""Studies: motions from random starts in each cell of a grid of dampers and frequencies.

Each cell has an index, counted in the order of `AXES`, the last axis fastest. A chunk is a range of
cells. The seed and the index of a cell set its starts, so results do not depend on the chunks.
"""

import math

import numpy as np

from impact_damper.data.datasets import dataset, flag, is_settled, load, oscillator_of, save
from impact_damper.data.motion_variables import OUTCOME
from impact_damper.data.variables import register
from impact_damper.data.whole_files import BrokenFileError
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, describe
from impact_damper.motions import ensemble
from impact_damper.motions.records import is_symmetric_pair
from impact_damper.motions.simulate import random_states
from impact_damper.motions.start_states import describe_search, warn_if_narrow
from impact_damper.motions.steady import CHUNK, run_chunks

register(
    """
cell | cell | | | number of the cell in the grid, the last axis fastest
counted_outcome | counted_outcome | | | outcome of a random start
outcome_count | cell counted_outcome | | | number of random starts with the outcome
quiet_count | cell | | | number of random starts that lead to the quiet orbit, which has period 1
  and touches each wall once in a cycle, symmetrically
best_clearance | mass_ratio frequency restitution | | d0 | clearance of the grid at which the
  largest motion that starts lead to is smallest
    """
)

AXES = ("mass_ratio", "clearance", "frequency", "restitution")
OUTCOMES = tuple(name for name, value in OUTCOME.items() if value >= 0)
# Results of a cell. The counts are numbers of starts, and the displacements are max |Z1|.
CELL = np.dtype(
    [
        ("outcome_count", "i4", len(OUTCOMES)),
        ("quiet_count", "i4"),
        ("largest_displacement", "f8"),
        ("quiet_displacement", "f8"),
    ]
)


def study_chunk(
    oscillator,
    axes,
    cells,
    *,
    contact_stiffness=2000.0,
    starts=8,
    radius,
    seed=1995,
    settling,
    workers=1,
    progress=None,
):
    """Return a dataset of the motions from random starts in cells `cells[0]` to `cells[1] - 1`."""
    axes = {name: np.asarray(axes[name], float) for name in AXES}
    shape, (first, last) = [len(values) for values in axes.values()], cells

    def system(place):
        values = {name: axis[i] for (name, axis), i in zip(axes.items(), place, strict=True)}
        frequency = values.pop("frequency")
        damper = Damper(contact_stiffness=contact_stiffness, **values)
        return pack(oscillator, damper, frequency), damper

    # Check the first and last values of the sorted axes, and the radius, before hours of work.
    for end in (0, -1):
        random_states(0, radius, system([end] * len(AXES))[1], seed)
    warn_if_narrow(oscillator, axes["frequency"], radius)
    found, stop = np.empty(last - first, CELL), np.zeros(1, bool)

    def work(part):
        rows, states = [], []
        for cell in range(first + part.start, first + part.stop):
            p, damper = system(np.unravel_index(cell, shape))
            states.append(random_states(starts, radius, damper, [seed, cell]))
            rows.append(np.tile(p, (starts, 1)))
        runs = ensemble.settle(np.concatenate(rows), np.concatenate(states), settling, stop=stop)
        for k, of_cell in enumerate(runs.reshape(-1, starts), part.start):
            found[k] = _condensed(of_cell)

    together = max(1, CHUNK // starts)  # number of cells that are run together
    run_chunks(work, last - first, workers, progress, stop, size=together)
    data = {
        name: (("cell", "counted_outcome")[: found[name].ndim], found[name]) for name in CELL.names
    }
    made = describe(oscillator, settling) | describe_search(starts, radius, seed)
    made["contact_stiffness"] = contact_stiffness
    coordinates = axes | {"cell": np.arange(first, last), "counted_outcome": list(OUTCOMES)}
    return dataset(data, coordinates, made, "Motions from random starts over a grid")


def _condensed(runs):
    sizes = runs["maximum_displacement"]
    quiet = is_settled(runs) & is_symmetric_pair(runs)
    return (
        [np.sum(runs["outcome"] == flag("outcome", name)) for name in OUTCOMES],
        np.sum(quiet),
        np.max(sizes),
        np.min(sizes[quiet]) if quiet.any() else np.nan,
    )


def gather_chunks(paths, path) -> None:
    """Join the chunks of a study in one file; raise BrokenFileError if a chunk is wrong."""
    chunks = [load(each) for each in paths]
    head, done = chunks[0], 0
    for chunk, each in zip(chunks, paths, strict=True):
        same = chunk.attrs == head.attrs and all(
            np.array_equal(chunk[name], head[name]) for name in (*AXES, "counted_outcome")
        )
        if not same or chunk["cell"].values[0] != done:
            raise BrokenFileError(f"{each} must begin at cell {done} of the same study")
        done += chunk.sizes["cell"]
    axes = {name: head[name].values for name in AXES}
    shape = tuple(len(values) for values in axes.values())
    if done != math.prod(shape):
        raise BrokenFileError(f"{paths[-1]} ends at cell {done} of {math.prod(shape)}")
    data = {}
    for name in head.data_vars:
        values = np.concatenate([chunk[name].values for chunk in chunks])
        data[name] = (*AXES, *head[name].dims[1:]), values.reshape(*shape, *values.shape[1:])
    best = np.argmin(data["largest_displacement"][1], axis=AXES.index("clearance"))
    inertia = np.multiply.outer(axes["mass_ratio"], axes["frequency"] ** 2)
    forcing = oscillator_of(head).forcing_amplitude(axes["frequency"])
    data["best_clearance"] = axes["clearance"][best]
    data["rule_clearance"] = ("mass_ratio", "frequency"), forcing / inertia
    coordinates = axes | {"counted_outcome": head["counted_outcome"].values}
    save(dataset(data, coordinates, {}, "").assign_attrs(head.attrs), path)
