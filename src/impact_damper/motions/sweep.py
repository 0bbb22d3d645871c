"""Find the motions along a sweep of one parameter, by runs from start states and by following.

At each value of the parameter motions are run from the starts of a search, and Newton's method
searches for further stable orbits. Each settled motion is then followed by Newton's method to the
next value, upward and downward, so that motions with small basins of attraction are found too. A
branch ends where its motion cannot be followed. Motions that have not settled are matched between
neighbouring values by `motions.matching`.

Z1 is the displacement of the primary mass.
"""

from itertools import count, pairwise

import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from impact_damper.data.datasets import flag, is_settled
from impact_damper.data.shares import wilson_intervals
from impact_damper.motions import ensemble
from impact_damper.motions.catalogue import SAME, Catalogue
from impact_damper.motions.following import StrobeOrbit, follow_stable
from impact_damper.motions.matching import match_unsettled
from impact_damper.motions.orbit_search import add_orbits
from impact_damper.motions.records import MOTION, measured, tabulate
from impact_damper.motions.strobe_map import STROBE

# Events at the end of a branch:
# CRITICAL  smallest modulus of a multiplier that shows a bifurcation; the last orbit before the
#           bifurcation may have a modulus slightly below 1
# COMPLEX   a multiplier is complex if its imaginary part exceeds this
# CLOSE     largest difference in max |Z1| between a symmetric motion and the asymmetric motion that
#           branches off
CRITICAL = 0.98
COMPLEX = 1e-3
CLOSE = 0.05


def _end_event(record, multiplier, beyond):
    """Return the name of the event that ends a branch.

    Parameters
    ----------
    record : records.MOTION
        The motion on the branch.
    multiplier : complex
        Dominant multiplier of its last orbit; NaN if Newton's method fails because the motion does
        not depend smoothly on its start.
    beyond : records.MOTION
        The motion that the state of the last orbit leads to at the next value of the parameter.
    """
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


def _follow(source, target, index, settling, links, ends):
    """Follow all motions of the catalogue `source` to the next value of the parameter.

    Motions found at the next value are entered in its catalogue `target`. For two motions on the
    same branch the pair of their numbers is appended to `links`. For each branch that ends between
    the two values a dictionary is appended to `ends`.
    """
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
        ends.append(
            {
                "end_value": p[index],
                "end_motion": source.numbers[i],
                "end_direction": flag(
                    "end_direction", "up" if target.p[index] > p[index] else "down"
                ),
                "end_event": flag("end_event", _end_event(record, multiplier, beyond)),
                "end_displacement": last["maximum_displacement"],
                "end_multiplier_real": multiplier.real,
                "end_multiplier_imaginary": multiplier.imag,
            }
        )


def _branches(catalogues, links):
    """Return the branch of each motion, indexed by the number of the motion.

    Branches are the connected components of the links. Links between motions that have not settled
    are added by `match_unsettled`.
    """
    links = links + [
        (first.numbers[i], second.numbers[j])
        for first, second in pairwise(catalogues)
        for i, j in match_unsettled(first.records, second.records)
    ]
    size = sum(len(catalogue.records) for catalogue in catalogues)
    pairs = np.array(links or [(0, 0)]).T
    return connected_components(coo_array((np.ones(len(pairs[0])), pairs), (size, size)), False)[1]


def _tables(catalogues, branches, dimension, starts):
    """Return variables with the dimensions (dimension, motion), by descending displacement.

    Rows with fewer motions are padded by motions with the outcome absent. `starts` is the number of
    random starts at each value.
    """
    width = max(len(catalogue.records) for catalogue in catalogues)
    records = np.zeros((len(catalogues), width), MOTION)
    records["outcome"] = flag("outcome", "absent")
    for name in (
        "residual",
        "maximum_displacement",
        "contacts",
        "asymmetry",
        "lyapunov_exponent",
        "lyapunov_error",
        "first_frequency",
        "second_frequency",
        "frequency_error",
        "state",
        "multiplier",
        "harmonic_displacement",
        "harmonic_relative",
    ):
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


def sweep(parameters, index, dimension, search, settling, *, workers=1, progress=None):
    """Find all motions along a sweep of one parameter.

    Parameters
    ----------
    parameters : array, shape (n, packed.COUNT)
        Packed parameters in the order of the sweep, which differ in one parameter.
    index : int
        Index of this parameter in the packed array: FREQUENCY or CLEARANCE.
    dimension : str
        Name of the dimension of the data for this parameter.
    search : start_states.Search
        Random and placed starts at each value, and states of the loose mass.
    settling : Settling
    workers, progress
        As in `ensemble.settle`.

    Returns
    -------
    dict
        Registered variables of the distinct motions, with the dimensions (dimension, motion); of
        the runs, with (dimension, start); of the ends of branches, with (end); and of the range of
        the search.
    """
    size, starts = search.random.shape[:2]
    runs = ensemble.settle(
        np.repeat(parameters, starts, axis=0),
        search.random.reshape(-1, 4),
        settling,
        workers=workers,
        progress=progress,
    ).reshape(size, starts)
    counts = [len(each) for each in search.placed]
    placed = ensemble.settle(
        np.repeat(parameters, counts, axis=0),
        np.concatenate(search.placed),
        settling,
        workers=workers,
        progress=progress if any(counts) else None,
    )
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
    links, ends = [], {}
    # The second sweep upward also follows the motions that the sweep downward found.
    for turn, order in (("up", catalogues), ("down", catalogues[::-1]), ("up", catalogues)):
        ends[turn] = []
        for source, target in zip(order, order[1:], strict=False):
            _follow(source, target, index, settling, links, ends[turn])
    branches = _branches(catalogues, links)
    ends = ends["down"] + ends["up"]
    data = _tables(catalogues, branches, dimension, starts)
    columns = [
        np.argsort(catalogue.order())[row]
        for catalogue, row in zip(catalogues, reached, strict=True)
    ]
    data |= {
        "run_outcome": ((dimension, "start"), runs["outcome"]),
        "run_motion": ((dimension, "start"), np.array(columns)),
        "run_length": ((dimension, "start"), runs["periods_run"]),
    }
    for name in (
        "end_value",
        "end_direction",
        "end_event",
        "end_displacement",
        "end_multiplier_real",
        "end_multiplier_imaginary",
    ):
        data[name] = np.array([end[name] for end in ends])
    data["end_branch"] = np.array([branches[end["end_motion"]] for end in ends], int)
    return data | search.variables(dimension)


def reached(data):
    """Return the mask of the motions of a `sweep` that a random or a placed start leads to."""
    return (data["motion_starts"][1] > 0) | (data["origin"][1] == flag("origin", "placed_start"))
