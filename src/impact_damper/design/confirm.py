"""The confirmation of a gap with new starts, and the decision whether to build the damper."""

from contextlib import suppress
from typing import NamedTuple

import numpy as np
import xarray as xr

from impact_damper.data.datasets import flag
from impact_damper.data.design_variables import KEEPS, WORTH
from impact_damper.data.shares import bounding_rank, starts_needed
from impact_damper.design.absorbers import absorber_responses
from impact_damper.design.promise import Promise, factor_sets
from impact_damper.design.search import score, search, search_around
from impact_damper.design.task import NOMINAL, NUMERICAL, SIDES, VARIED, Task, labelled

# A round runs the best gap on the curve of the search with new starts, and corrects the curve. Up
# to ROUNDS rounds follow each other. They end early if the best gap was run in an earlier round, or
# if the least promised displacement is at most CONFIRMED x the best gap's tolerated displacement.
CONFIRMED, ROUNDS = 1.05, 4
# If the promised displacement of a gap exceeds SURPRISE x the largest displacement that the search
# has found at the gaps within its tolerance, nearby gaps are searched again.
SURPRISE = 1.1


class Tried(NamedTuple):
    """A gap (mm) that was run with new starts, and the bounds of the displacement at this gap."""

    gap: float
    promise: Promise

    @property
    def harmful(self) -> np.ndarray:
        """Sets of factors: the nominal set, and the worst set with 1 as the factor of the gap."""
        worst = self.promise.sets[self.promise.worst[0]].copy()
        worst[0] = 1
        return np.unique([NOMINAL, worst], axis=0)

    @property
    def by_gap(self) -> float:
        """Promised displacement if only the gap deviates from its nominal value, mm."""
        only = (self.promise.sets[:, 1:] == 1).all(axis=1)
        return float(self.promise.by_set()[only].max())


def find_gap(task: Task, progress=None) -> xr.Dataset:
    """Search for the best gap, confirm the gap with new starts, and return the decision."""
    curve, tried, status = search(task, progress), [], "rounds_ended"
    for turn in range(ROUNDS):
        choice = curve.choose()
        if any(each.gap == choice.gap for each in tried):
            status = "confirmed"
            break
        sets = np.vstack([factor_sets(task, choice.gap), curve.worst_inside(choice.gap)])
        tried.append(confirm(task, choice.gap, turn, sets, progress))
        learn(task, tried[-1], turn, curve, progress)
        best = min(tried, key=lambda each: each.promise.size)
        if best.promise.size <= CONFIRMED * curve.choose().size:
            status = "confirmed"
            break
    best = min(tried, key=lambda each: each.promise.size)
    if len(tried) > 1:  # the smallest of several promises is too small on average
        best = confirm(task, best.gap, len(tried), best.promise.sets, progress)
    return conclude(task, best, curve, status)


def evaluate_gap(task: Task, progress=None) -> xr.Dataset:
    """Return the dataset of the decision on the given gap, `task.gap`."""
    gap = 1e3 * task.gap
    found = confirm(task, gap, 0, factor_sets(task, gap), progress)
    curve = search_around(task, gap, found.harmful, progress)
    return conclude(task, found, curve, "given")


def confirm(task, gap, turn, sets, progress=None) -> Tried:
    """Run a gap (mm) with new random starts. Each integer `turn` gives different starts."""
    stream = "confirmed", turn
    return Tried(gap, Promise(task, 1e-3 * gap, sets, stream, progress=progress).refined())


def learn(task, tried, turn, curve, progress=None) -> None:
    """Put the bounds of the gap in `tried` into `curve`.

    After a surprise (see SURPRISE), nearby gaps are searched again. `turn` counts the rounds.
    """
    gap, promise = tried.gap, tried.promise
    sizes, factors = promise.by_set(), promise.sets[:, 0]
    expected = curve.within(*np.array(task.gap_ends(gap))[:, None])[0]
    worst = [
        frequency[np.argmax(size)]
        for frequency, size in map(promise.over_frequency, range(len(sizes)))
    ]
    for factor in np.unique(factors):
        k = int(np.argmax(np.where(factors == factor, sizes, -np.inf)))
        curve.put([gap * factor], [sizes[k]], [worst[k]], replace=True)
    if promise.size > SURPRISE * expected:
        reach = SURPRISE * factors.max()
        near = curve.gaps[(curve.gaps > gap / reach) & (curve.gaps < gap * reach)]
        given = np.unique(worst), starts_needed(task.share), ("compared", 100 + turn), progress
        curve.put(near, *score(task, near, *given, tried.harmful)[:2])


def conclude(task, found, curve, status) -> xr.Dataset:
    """Return the dataset of the decision on the gap `found`, which was run with new starts.

    The dataset also holds the `curve` of the search, and `status` as the variable `confirmation`.
    """
    promise = found.promise
    frequencies = np.unique([f for _, f in promise.cells])
    table = np.full((len(promise.sets), len(frequencies)), np.nan)
    for (k, f), bound in zip(promise.cells, promise.bounds, strict=True):
        table[k, np.searchsorted(frequencies, f)] = bound
    worst_set, worst_frequency = promise.worst
    bare = task.bare_at(frequencies)
    most = float(task.bare.max())
    ratio = np.where(np.isfinite(bare), table[0] / bare, 0.0)  # 0 where bare is infinite
    k = int(np.nanargmax(ratio))
    limit = np.nan if task.displacement_limit is None else 1e3 * task.displacement_limit
    lost, lost_sizes = curve.lost(found.gap, KEEPS * promise.size)
    kinds = np.where(lost_sizes > 1.5 * KEEPS * promise.size, "jump", "growth")
    kinds[np.isnan(lost)] = "none"
    ranges = curve.ranges()
    built = promise.size <= (1 - WORTH) * most
    limit_status = "none" if np.isnan(limit) else "met" if promise.size <= limit else "missed"
    nominal = [place for place, cell in enumerate(promise.cells) if cell[0] == 0]
    order = np.argsort([promise.cells[place][1] for place in nominal])
    records = promise.motions.records[nominal][order]
    settled = promise.motions.settled[nominal][order]
    late = np.where(settled, records["periods_run"], np.nan)
    known = np.isin(frequencies, [promise.cells[place][1] for place in nominal])
    unsettled, waits = np.full((2, len(frequencies)), np.nan)
    unsettled[known] = 1 - settled.mean(axis=1)
    waits[known] = [
        np.quantile(row[np.isfinite(row)], 0.95) if np.isfinite(row).any() else np.nan
        for row in late
    ]
    values = {
        "design_gap": found.gap,
        "decision": flag("decision", "build" if built else "do_not_build"),
        "migration_offer": flag("migration_offer", "no" if built else task.migration_offer),
        "displacement_limit": limit,
        "limit_status": flag("limit_status", limit_status),
        "promised_displacement": promise.size,
        "promised_frequency": worst_frequency,
        "promised_set": int(worst_set),
        "promised_share": task.share,
        "promise_starts": promise.count,
        "promise_rank": bounding_rank(task.share, promise.count),
        "gap_promised_displacement": found.by_gap,
        "confirmation": flag("confirmation", status),
        "peak_status": flag("peak_status", "known" if promise.peak_known else "not_known"),
        "record_status": flag("record_status", "still_grows" if promise.grows else "known"),
        "largest_bare_displacement": most,
        "largest_bare_frequency": task.worst_frequency,
        "least_ratio": float(np.nanmin(ratio)),
        "worst_ratio": float(ratio[k]),
        "worst_ratio_frequency": float(frequencies[k]),
        "branch_frequency": float(frequencies[np.nanargmax(table[0])]),
        "lost_gap": lost,
        "lost_displacement": lost_sizes,
        "lost_kind": [flag("lost_kind", str(each)) for each in kinds],
        "range_gap": [(each.low, each.high) for each in ranges],
        "range_displacement": [each.size for each in ranges],
        "promise_factor": promise.sets,
        "promise_displacement": table,
        "promise_bare_displacement": bare,
        "unsettled_share": unsettled,
        "settling_late": waits,
        "searched_displacement": curve.sizes,
        "searched_tolerated": curve.within(*task.gap_ends(curve.gaps)),
    }
    return labelled(
        values,
        frequency=task.grid,
        promise_frequency=frequencies,
        searched_gap=curve.gaps,
        side=SIDES,
        varied=list(VARIED),
    ).merge(rivals(task))


def rivals(task) -> xr.Dataset:
    """Return largest displacements (mm) with a tuned, a detuned and the given absorber."""
    names = ("tuned_displacement", "detuned_displacement", "own_absorber_displacement")
    values = dict.fromkeys(names, np.nan)
    given = task.machine, task.mass, task.grid, [1.0]
    with suppress(*NUMERICAL):
        found = absorber_responses(*given, band=task.absorber_band, own=task.absorber)
        sizes = found["competitor_displacement"].sel(force_share=1.0).max("frequency", skipna=False)
        worst = sizes.sel(competitor="tuned")
        values[names[0]], values[names[1]] = worst.sel(detuning=0.0), worst.max(skipna=False)
        if task.absorber is not None:
            values[names[-1]] = sizes.sel(competitor="own", detuning=0.0)
    return labelled({name: float(value) for name, value in values.items()})
