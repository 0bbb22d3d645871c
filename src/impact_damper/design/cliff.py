"""The basin cliff: the gaps at which starts cease to end quiet, and those at which the orbit ends.

With a contact that loses energy the quiet orbit is smallest close to the gap at which it loses its
stability, where hardly any start reaches it. At a smaller gap all starts do. Between the two the
share of quiet starts falls within a few per cent of the gap: the cliff. Beside the quiet orbit the
motion is chaotic there, for a time only (a transient) or for good (an attractor).
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag, is_settled
from impact_damper.data.shares import escape_rate, wilson
from impact_damper.design.choose import middle_gap
from impact_damper.design.compare import compare
from impact_damper.design.deviations import choose_with_tolerances
from impact_damper.design.outcomes import Case, are_quiet, run
from impact_damper.orbits.branches import Branch, follow_branch
from impact_damper.orbits.orbit import STROBE, Orbit
from impact_damper.orbits.quiet_orbits import is_symmetric_pair
from impact_damper.orbits.shooting import find_orbit
from impact_damper.system.families import family_of

# Bisections of each edge, and number of frequencies, those of least share, at which it is sought.
BISECTIONS, CRITICAL = 4, 2
# Least width of a range of quiet gaps in which a gap can be held, divided by the gap, unless the
# tolerance given is closer.
HOLDABLE = 0.01
# Lives of chaotic motions: gaps, divided by that of the cliff or, at the lower end, the inverse;
# starts at each; longest run and time before which a motion may still be on its way, in forcing
# periods; least number of motions that last longer than this time.
LIFE_GAPS = (0.99, 1.02, 1.06, 1.12, 1.2)
LIFE_STARTS, LONGEST, LEAD, FEWEST = 32, 3000, 200, 5
# Least and greatest gap and force of branches of quiet orbits, divided by the nominal values.
GAP_SPAN, FORCE_SPAN = (0.4, 2.0), (0.25, 4.0)


class Edge(NamedTuple):
    """An end of the range of quiet gaps.

    Attributes
    ----------
    gap : float
        mm; the last gap known to be quiet, after the comparison at the frequencies at which the
        next one is least quiet. NaN without such a range.
    beyond : float
        mm; the first gap known not to be quiet, NaN where the comparison ends before.
    status : int
        Flag of `cliff_status`.
    frequency : float
        Hz; that of the least share of quiet starts at `beyond`, NaN if this is NaN.
    """

    gap: float
    beyond: float
    status: int
    frequency: float


NO_EDGE = Edge(np.nan, np.nan, flag("cliff_status", "no_quiet_gap"), np.nan)


def find_edges(task, comparison, gap, *, workers=1) -> tuple[Edge, Edge]:
    """Return the lower and the upper end of the range of quiet gaps around a gap.

    The comparison brackets each end between two gaps. They are bisected with all starts at the
    frequencies of least share.

    Parameters
    ----------
    task : Task
    comparison : choose.Comparison
    gap : float
        Nominal gap, mm.
    workers : int
    """
    quiet = comparison.quiet
    inner = np.flatnonzero(quiet)
    if len(inner) == 0:
        return NO_EDGE, NO_EDGE
    k = inner[np.argmin(np.abs(np.log(comparison.gaps[inner] / gap)))]
    found = []
    for step in (-1, 1):
        last = k
        while 0 <= last + step < len(quiet) and quiet[last + step]:
            last += step
        if not 0 <= last + step < len(quiet):
            edge = float(comparison.gaps[last])
            found.append(Edge(edge, np.nan, flag("cliff_status", "range_ends"), np.nan))
        else:
            found.append(_bisect(task, comparison, last, last + step, workers))
    return tuple(found)


def _bisect(task, comparison, last, beyond, workers):
    """Return the edge between two neighbouring gaps of a comparison, the first of them quiet."""
    shares = comparison.numbers["start_quiet_share"][beyond]
    critical = comparison.frequencies[np.argsort(shares, kind="stable")[:CRITICAL]]
    inside, outside = comparison.gaps[last], comparison.gaps[beyond]
    limit = comparison.limit
    for _ in range(BISECTIONS):
        middle = np.sqrt(inside * outside)
        found = compare(task, [middle], critical, limit, task.starts, "edges", workers=workers)
        if found.quiet[0]:
            inside = middle
        else:
            outside = middle
    return Edge(float(inside), float(outside), flag("cliff_status", "found"), float(critical[0]))


def choose_with_edges(task, comparison, *, progress=None, workers=1):
    """Return the choice of a gap and the ends of the range of quiet gaps around it.

    A range that must be held more closely than the tolerance is measured by its ends. If it is
    narrower than HOLDABLE, no one can hold it: its gaps are left out, and the choice is made again.

    Parameters
    ----------
    task : Task
    comparison : choose.Comparison
    progress : str, optional
        Title of a progress bar.
    workers : int

    Returns
    -------
    Choice
    edges : tuple of Edge
        The lower and the upper end.
    """
    tolerance = task.tolerances.get("gap", 0.0)
    while True:
        choice = comparison.choose(tolerance)
        choice = choose_with_tolerances(
            task, comparison, choice, progress=progress, workers=workers
        )
        edges = find_edges(task, comparison, choice.gap, workers=workers)
        if choice.kind != "needs_tolerance":
            return choice, edges
        if can_be_held(edges, tolerance):
            return _recentred(task, choice, edges, comparison.limit, workers), edges
        low, high = (edge.gap for edge in edges)
        comparison = comparison.without(low, high)


def can_be_held(edges, tolerance) -> bool:
    """Return whether a gap can be held between two edges, when it deviates by a tolerance."""
    low, high = (edge.gap for edge in edges)
    return high - low >= min(HOLDABLE, 2 * tolerance) * np.sqrt(low * high)


def _recentred(task, choice, edges, limit, workers):
    """Return the choice, moved to the middle of a narrow range of quiet gaps if that is quiet.

    The comparison knows such a range by a few gaps only, which may lie close to an end.
    """
    gap = middle_gap(*(edge.gap for edge in edges))
    found = compare(task, [gap], task.grid, limit, task.starts, "middle", workers=workers)
    return choice._replace(gap=gap) if found.quiet[0] else choice


class Lives(NamedTuple):
    """How long motions last that are not quiet, over the gap.

    Attributes
    ----------
    gaps : numpy.ndarray, shape (k,)
        mm.
    share : numpy.ndarray, shape (k, 3)
        Share of starts that end quiet within LONGEST periods, with its interval.
    rate : numpy.ndarray, shape (k, 3)
        Rate at which motions become quiet after LEAD periods, per forcing period, with its
        interval; NaN where fewer than FEWEST last so long. A rate whose interval begins at 0 is
        that of an attractor, or of a transient whose mean life exceeds the inverse of the upper
        end.
    """

    gaps: np.ndarray
    share: np.ndarray
    rate: np.ndarray


def find_lives(task, edge, limit, *, workers=1, progress=None) -> Lives:
    """Return how long motions that are not quiet last, at gaps across an edge.

    Parameters
    ----------
    task : Task
    edge : Edge
        With a gap beyond.
    limit : float
        Largest displacement of a quiet motion, mm.
    workers, progress
        As in `outcomes.run`.
    """
    outward = 1 if edge.beyond > edge.gap else -1
    gaps = edge.gap * np.array(LIFE_GAPS) ** outward
    cases = [Case(1e-3 * gap, edge.frequency) for gap in gaps]
    # a transient is certainly chaotic too, so that only the end of the run may stop it
    running = {"settling": task.lasting(LONGEST), "workers": workers, "progress": progress}
    records = run(task, cases, LIFE_STARTS, "lives", **running)
    sizes = task.millimetres(records["maximum_displacement"])
    quiet = are_quiet(sizes, records["outcome"], limit)
    settled = is_settled(records)
    lives = np.where(quiet & settled, records["periods_run"], LONGEST + 1)
    rates = []
    # when a motion that goes on without settling became quiet, if it is, is not known
    for row, known in zip(lives, settled | ~quiet, strict=True):
        lasting = row[known]
        enough = np.sum(lasting > LEAD) >= FEWEST
        rates.append(escape_rate(lasting, LONGEST, LEAD) if enough else np.full(3, np.nan))
    shares = [wilson(count, LIFE_STARTS) for count in quiet.sum(axis=1)]
    return Lives(gaps, np.array(shares), np.array(rates))


class QuietBranch(NamedTuple):
    """A branch of quiet orbits over one parameter.

    Attributes
    ----------
    branch : Branch
    start : int
        Index of the point at the nominal value.
    nominal : float
        Nominal value of the parameter, dimensionless.
    """

    branch: Branch
    start: int
    nominal: float


def quiet_orbit(task, gap, frequency, *, workers=1) -> Orbit | None:
    """Return the smallest quiet orbit that starts reach at a gap (mm) and frequency (Hz), or None.

    It is symmetric, with two contacts in a forcing period.
    """
    case = Case(1e-3 * gap, frequency)
    records = run(task, [case], task.starts, "orbit", workers=workers)[0]
    pairs = records[is_symmetric_pair(records)]
    if len(pairs) == 0:
        return None
    state = pairs["state"][np.argmin(pairs["maximum_displacement"])]
    orbit = find_orbit(task.packed(*case), state, 1, STROBE)
    return orbit if orbit.converged else None


def quiet_branch(task, gap, frequency, orbit, parameter) -> QuietBranch | None:
    """Return the branch of a quiet orbit over a parameter, None without an orbit.

    Parameters
    ----------
    task : Task
    gap, frequency : float
        mm and Hz, of the orbit.
    orbit : Orbit or None
    parameter : str
        "clearance", followed in its logarithm, "force" or "unbalance".
    """
    if orbit is None:
        return None
    oscillator, damper, turning = task.system(1e-3 * gap, frequency)
    owner = damper if parameter == "clearance" else oscillator
    nominal = getattr(owner, parameter)
    ends = GAP_SPAN if parameter == "clearance" else FORCE_SPAN
    span = tuple(nominal * end for end in ends)
    family, value, span = family_of(oscillator, damper, turning, parameter, span)
    branch = follow_branch(family, orbit, value, span)
    return QuietBranch(branch, int(np.argmin(np.abs(branch.values - value))), nominal)
