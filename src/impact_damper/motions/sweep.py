"""Find the motions along a sweep of one parameter, by runs from start states and by following.

At each value of the parameter Newton's method also finds stable orbits to which hardly any random
start leads. Settled motions are followed to the next values, upward and downward. Other motions are
run from their last states at the next values. Two unsettled motions at neighbouring values belong
to one branch if their outcomes and periods (0 if none) are equal and their sizes are similar.
"""

import math
from itertools import count, pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from impact_damper.data.datasets import flag, is_settled
from impact_damper.data.shares import wilson_intervals
from impact_damper.model.packed import CLEARANCE
from impact_damper.motions import ensemble
from impact_damper.motions.following import StrobeOrbit, follow_stable
from impact_damper.motions.records import MOTION, measured, tabulate
from impact_damper.motions.steady import run_chunks
from impact_damper.motions.strobe_map import STROBE, distance, flow, polish, strobe_time

# Two records are of one motion if their max |Z1| differ by less than the fraction SAME, or by less
# than ROUNDING. For two records of unsettled motions a `size_ratio` below SIMILAR is enough.
# A motion is symmetric if its asymmetry is below SAME.
SAME, ROUNDING, SIMILAR = 1e-6, 1e-11, 1.5
# Outcomes with infinite or zero max |Z1|. All motions with one such outcome count as one motion.
ALIKE = tuple(flag("outcome", name) for name in ("diverged", "escaped", "at_rest"))
# Search for orbits by Newton's method. LONGEST: longest period in cycles. REACH: largest distance
# of an orbit from its first guess, divided by the clearance or by a known motion's |Z1| or |Z1'|,
# whichever is greatest. SAME_ORBIT: two orbits are equal if their states differ by less than this.
LONGEST, REACH, SAME_ORBIT = 5, 1.0, 1e-6
# Events at the end of a branch. At a bifurcation the modulus of the orbit's multiplier is above
# CRITICAL. A multiplier is complex if its imaginary part is above COMPLEX. At a loss of symmetry
# max |Z1| of the orbit and of the motion beyond the end differ by less than CLOSE.
CRITICAL, COMPLEX, CLOSE = 0.98, 1e-3, 0.05


def sweep(parameters, index, dimension, search, settling, *, workers=1, progress=None):
    """Find all motions along a sweep of one parameter; return dataset variables as a dict.

    The rows of packed `parameters` differ in the column `index`, which holds the parameter named
    `dimension`. `search` holds start states for each row. Variables that describe motions lie over
    (`dimension`, motion). Variables that describe runs from random starts lie over
    (`dimension`, start). Variables that describe ends of branches lie over (end).
    """
    size, starts = search.random.shape[:2]
    rows, states = np.repeat(parameters, starts, axis=0), search.random.reshape(-1, 4)
    runs = ensemble.settle(rows, states, settling, workers=workers, progress=progress)
    runs = runs.reshape(size, starts)
    counts = [len(each) for each in search.placed]
    rows, states = np.repeat(parameters, counts, axis=0), np.concatenate(search.placed)
    title = progress if any(counts) else None
    placed = ensemble.settle(rows, states, settling, workers=workers, progress=title)
    numbering = count()
    catalogues = [Catalogue(p, numbering) for p in parameters]
    reached = [
        [catalogue.add(record, "random_start") for record in row]
        for catalogue, row in zip(catalogues, runs, strict=True)
    ]
    for catalogue, part in zip(catalogues, np.split(placed, np.cumsum(counts)[:-1]), strict=True):
        for record in part:
            catalogue.add(record, "placed_start")
    add_orbits(catalogues, search.loose, settling, workers)
    links, passes = [], []
    # Upward, downward, upward: the last pass also follows motions found on the way downward.
    for order in (catalogues, catalogues[::-1], catalogues):
        passes.append([])
        for source, target in pairwise(order):
            _follow(source, target, index, settling, links, passes[-1])
    branches = _branches(catalogues, links)
    ends = passes[1] + passes[2]
    data = _tables(catalogues, branches, dimension, starts)
    columns = [np.argsort(each.order())[row] for each, row in zip(catalogues, reached, strict=True)]
    data |= {
        "run_outcome": ((dimension, "start"), runs["outcome"]),
        "run_motion": ((dimension, "start"), np.array(columns)),
        "run_length": ((dimension, "start"), runs["periods_run"]),
    }
    for name in ("end_value", "end_direction", "end_event", "end_displacement"):
        data[name] = np.array([end[name] for end in ends])
    data["end_branch"] = np.array([branches[end["end_motion"]] for end in ends], int)
    return data | search.variables(dimension)


def reached(data):
    """Return True for motions to which a random or placed start leads. `data` is from `sweep`."""
    return (data["motion_starts"][1] > 0) | (data["origin"][1] == flag("origin", "placed_start"))


def _follow(source, target, index, settling, links, ends):
    followed = [
        follow_stable(source.p, record["state"], record["period"], index, target.p[index])
        if is_settled(record)
        else (source.p, StrobeOrbit(record["state"], complex(np.nan)))
        for record in source.records
    ]
    states = np.array([orbit.state for _, orbit in followed]).reshape(-1, 4)
    rows = np.tile(target.p, (len(states), 1))
    settled = ensemble.settle(rows, states, settling, from_strobe=True)
    for i, (record, beyond) in enumerate(zip(list(source.records), settled, strict=True)):
        p, (state, multiplier) = followed[i]
        j = target.add(beyond, "followed")
        if not is_settled(record):
            continue
        arrived = p[index] == target.p[index]
        if arrived and is_settled(beyond) and beyond["period"] == record["period"]:
            links.append((source.numbers[i], target.numbers[j]))
            continue
        last = measured(p, state, int(record["period"]), settling.tolerance)
        direction = "up" if target.p[index] > p[index] else "down"
        ends.append(
            {
                "end_value": p[index],
                "end_motion": source.numbers[i],
                "end_direction": flag("end_direction", direction),
                "end_event": flag("end_event", _end_event(record, multiplier, beyond)),
                "end_displacement": last["maximum_displacement"],
            }
        )


def _end_event(record, multiplier, beyond):
    if not abs(multiplier) >= CRITICAL:
        return "not_smooth"
    if abs(multiplier.imag) > COMPLEX:
        return "neimark_sacker"
    if multiplier.real < 0:
        return "period_doubling"
    close = abs(beyond["maximum_displacement"] - record["maximum_displacement"]) < CLOSE
    splits = record["asymmetry"] < SAME and not beyond["asymmetry"] < SAME
    if close and splits and beyond["period"] == record["period"]:
        return "symmetry_breaking"
    return "fold"


def _branches(catalogues, links):
    links = links + [
        (first.numbers[i], second.numbers[j])
        for first, second in pairwise(catalogues)
        for i, j in match_unsettled(first.records, second.records)
    ]
    size = sum(len(catalogue.records) for catalogue in catalogues)
    pairs = np.array(links or [(0, 0)]).T
    return connected_components(coo_array((np.ones(len(pairs[0])), pairs), (size, size)), False)[1]


def _tables(catalogues, branches, dimension, starts):
    width = max(len(catalogue.records) for catalogue in catalogues)
    records = np.zeros((len(catalogues), width), MOTION)
    records["outcome"] = flag("outcome", "absent")
    for name in MOTION.names:
        if MOTION[name].base.kind in "fc":
            records[name] = np.nan
    extra = {
        "branch": np.full(records.shape, -1),
        "motion_starts": np.zeros(records.shape, int),
        "origin": np.full(records.shape, flag("origin", "absent")),
    }
    for row, catalogue in enumerate(catalogues):
        for column, k in enumerate(catalogue.order()):
            records[row, column] = catalogue.records[k]
            extra["branch"][row, column] = branches[catalogue.numbers[k]]
            extra["motion_starts"][row, column] = catalogue.starts[k]
            extra["origin"][row, column] = catalogue.origins[k]
    interval = np.full((2, *records.shape), np.nan)
    present = records["outcome"] != flag("outcome", "absent")
    if starts:
        interval[:, present] = wilson_intervals(extra["motion_starts"][present], starts).T
    extra |= {"share_lower": interval[0], "share_upper": interval[1]}
    data = tabulate(records) | extra
    dims = (dimension, "motion")
    return {name: (dims, values) for name, values in data.items()} | {
        "state": ((*dims, "component"), records["state"]),
        "state_phase": ((), STROBE),
    }


class Catalogue:
    """Distinct motions at one value of the swept parameter, with packed parameters p.

    Each motion has a record, a serial number from the iterator `numbering`, a flag for how it was
    found (`origins`), and the number of random starts that lead to it (`starts`).
    """

    def __init__(self, p, numbering):
        self.p = p
        self.numbering = numbering
        self.records, self.numbers, self.origins, self.starts = [], [], [], []

    def find(self, record):
        """Return the index of a record's motion or its mirror image; None if neither is known."""
        for i, known in enumerate(self.records):
            if known["outcome"] != record["outcome"] or known["period"] != record["period"]:
                continue
            if record["outcome"] in ALIKE:
                return i
            size = known["maximum_displacement"]
            near = abs(record["maximum_displacement"] - size) < max(SAME * size, ROUNDING)
            near = near and abs(record["contacts"] - known["contacts"]) < 1e-9
            if near or (not is_settled(record) and size_ratio(record, known) < SIMILAR):
                return i
        return None

    def add(self, record, origin):
        """Add the motion of a record, unless the motion is known; return the motion's index.

        `origin` says how the motion was found. The record with the larger max |Z1| is kept.
        """
        i = self.find(record)
        if i is None:
            i = len(self.records)
            self.records.append(record)
            self.numbers.append(next(self.numbering))
            self.origins.append(flag("origin", origin))
            self.starts.append(0)
        elif record["maximum_displacement"] > self.records[i]["maximum_displacement"] + SAME:
            self.records[i] = record
        self.starts[i] += origin == "random_start"
        return i

    def order(self):
        """Return the indices of the motions by descending max |Z1|."""
        return np.argsort([record["maximum_displacement"] for record in self.records])[::-1]


def match_unsettled(first, second) -> list:
    """Return pairs (i, j) of unsettled motions first[i] and second[j] that have similar sizes."""
    pairs = sorted(
        (ratio, i, j)
        for i, one in enumerate(first)
        for j, other in enumerate(second)
        if not is_settled(one)
        and one["outcome"] == other["outcome"]
        and one["period"] == other["period"]
        and (ratio := size_ratio(one, other)) < SIMILAR
    )
    matched = []
    for _, i, j in pairs:
        if all(i != k and j != m for k, m in matched):
            matched.append((i, j))
    return matched


def size_ratio(one, other):
    """Return the larger max |Z1| of two motions divided by the smaller.

    A motion without a period may have a small max |Z1| by chance. For two such motions `reach`, the
    largest (Z1^2 + (Z1'/W)^2)^(1/2) at strobes, also gives a ratio. The smaller ratio is returned.
    """
    if one["maximum_displacement"] == other["maximum_displacement"]:
        return 1.0
    ratios = []
    for name in ["maximum_displacement"] if one["period"] else ["maximum_displacement", "reach"]:
        smaller, larger = sorted((float(one[name]), float(other[name])))
        unequal = larger / smaller if smaller else math.inf
        ratios.append(1.0 if larger == smaller else unequal)
    return min(ratios)


def add_orbits(catalogues, loose, settling, workers) -> None:
    """Search for further stable orbits at each value of the parameter; add them to `catalogues`."""
    found, stop = [np.empty((0, 4))] * len(catalogues), np.zeros(1, bool)

    def work(part):
        for k in range(part.start, part.stop):
            known = catalogues[k].records
            records = [each for each in known if np.isfinite(each["maximum_displacement"])]
            motions = np.array([each["state"][:2] for each in records])
            found[k] = stable_orbits(catalogues[k].p, motions, loose[k], settling.tolerance, stop)

    run_chunks(work, len(catalogues), workers, None, stop, size=1)
    for catalogue, states in zip(catalogues, found, strict=True):
        rows = np.tile(catalogue.p, (len(states), 1))
        for record in ensemble.settle(rows, states, settling, from_strobe=True):
            catalogue.add(record, "followed")


def stable_orbits(p, motions, loose, tolerance, stop) -> np.ndarray:
    """Return states at the strobe, shape (k, 4), on stable orbits with contacts.

    On most orbits the primary mass moves nearly as in a known motion. So a start of Newton's method
    takes Z1, Z1' from a known motion, a row of `motions` (m, 2). It takes Z2 and the loose
    mass's velocity, Z1' - Z2', from a row of `loose` (n, 2). Each row of `loose` gives one start.
    """
    found, none = [], np.empty((0, 4))
    if len(motions) == 0 or len(loose) == 0:
        return none
    reach = REACH * max(np.max(np.abs(motions)), p[CLEARANCE])
    primary = np.resize(motions, loose.shape)
    starts = np.column_stack([primary, loose[:, 0], primary[:, 1] - loose[:, 1]])
    for periods in range(1, LONGEST + 1):
        for start in starts:
            if stop[0]:
                return none
            state = start.copy()
            converged, _, multiplier = polish(p, state, periods, reach, tolerance)
            if not converged or not abs(multiplier) < 1:
                continue
            if any(distance(state, each, 1.0) < SAME_ORBIT for each in found):
                continue
            run = state.copy()
            contacts, _ = flow(p, run, none, strobe_time(p), periods, np.bool_(False), tolerance)
            if contacts:
                found.append(state)
    return np.array(found).reshape(-1, 4)
