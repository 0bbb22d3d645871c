"""The basin cliff: gaps at which starts cease to lead to quiet motions, and stability of the orbit.

The quiet orbit is the periodic motion for which a damper is designed. It is symmetric, and the
loose mass presses each wall once in a forcing cycle. A start is a random initial state. A start is
called quiet if it leads to a motion below the quiet limit, a bound on the displacement.

With a contact that loses energy the quiet orbit is smallest close to the gap at which it loses its
stability. At this gap hardly any start leads to the orbit, but at a smaller gap all starts do.
Between the two gaps the share of quiet starts falls from 1 to nearly 0 while the gap grows by a few
per cent: this is the cliff. The other starts lead to chaos, which is a transient or lasts for good
(an attractor).
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import flag, is_settled
from impact_damper.data.shares import escape_rate, wilson
from impact_damper.design.choose import middle_gap
from impact_damper.design.compare import compare
from impact_damper.design.deviations import choose_with_tolerances
from impact_damper.design.outcomes import Case, are_quiet, run
from impact_damper.model.families import family_of
from impact_damper.orbits.branches import Branch, follow_branch
from impact_damper.orbits.orbit import STROBE, Orbit
from impact_damper.orbits.quiet_orbits import is_symmetric_pair
from impact_damper.orbits.shooting import find_orbit

# An edge is an end of a range of quiet gaps.
# BISECTIONS: number of bisections between two compared gaps, of which only one is quiet.
# CRITICAL: number of frequencies at which a gap is tested: those with the smallest shares of quiet
#     starts.
BISECTIONS, CRITICAL = 4, 2
# Width of a range of gaps divided by the gap, below which a builder is assumed unable to keep a gap
# within the range. If the tolerance of the gap is below half this bound, the bound is twice the
# tolerance.
HOLDABLE = 0.01
# The life of a chaotic motion is the time until it becomes quiet.
# LIFE_GAPS: gaps divided by the gap of the upper edge; the inverse at the lower edge.
# LIFE_STARTS: starts at each gap.
# LONGEST: longest run, in cycles.
# LEAD: initial time that is ignored, in cycles, because motions still approach the chaos.
# FEWEST: least number of motions that must last longer than LEAD to estimate a mean life.
LIFE_GAPS = (0.99, 1.02, 1.06, 1.12, 1.2)
LIFE_STARTS, LONGEST, LEAD, FEWEST = 32, 3000, 200, 5
# Least and greatest gap and force of branches of quiet orbits, divided by the nominal values.
GAP_SPAN, FORCE_SPAN = (0.4, 2.0), (0.25, 4.0)


class Edge(NamedTuple):
    """An end of the range of quiet gaps.

    Attributes
    ----------
    gap : float
        mm; the last gap known to be quiet. NaN if no range of gaps is quiet. To save time, a gap of
        a bisection is tested only at the CRITICAL frequencies.
    beyond : float
        mm; the first gap known not to be quiet. NaN if all gaps up to the end of the comparison are
        quiet.
    status : int
        Flag of `cliff_status`.
    frequency : float
        Hz; frequency of the smallest share of quiet starts at `beyond`, NaN if `beyond` is NaN.
    """

    gap: float
    beyond: float
    status: int
    frequency: float


NO_EDGE = Edge(np.nan, np.nan, flag("cliff_status", "no_quiet_gap"), np.nan)


def find_edges(task, comparison, gap, *, workers=1) -> tuple[Edge, Edge]:
    """Return the lower and the upper end of the range of quiet gaps around a gap.

    The comparison brackets each end between two gaps. Each bracket is bisected, with all starts at
    the frequencies with the smallest shares of quiet starts.

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
    """Return the edge between two neighbouring gaps of a comparison.

    `last` is the index of the quiet gap, and `beyond` the index of the other gap.
    """
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

    If the range is narrower than HOLDABLE, a gap cannot be held in it. Then its gaps are left out,
    and the choice is made again.

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
    """Return whether a gap can be kept between two edges by a builder, see HOLDABLE."""
    low, high = (edge.gap for edge in edges)
    return high - low >= min(HOLDABLE, 2 * tolerance) * np.sqrt(low * high)


def _recentred(task, choice, edges, limit, workers):
    """Return the choice, moved to the middle of a narrow range of quiet gaps.

    The few gaps that the comparison has in such a range may lie close to its end. If the middle
    turns out not to be quiet, the choice is returned unchanged.
    """
    gap = middle_gap(*(edge.gap for edge in edges))
    found = compare(task, [gap], task.grid, limit, task.starts, "middle", workers=workers)
    return choice._replace(gap=gap) if found.quiet[0] else choice


class Lives(NamedTuple):
    """Lives of motions that are not quiet, at several gaps.

    Attributes
    ----------
    gaps : numpy.ndarray, shape (k,)
        mm.
    share : numpy.ndarray, shape (k, 3)
        Share of starts whose motions become quiet within LONGEST cycles, with the ends of its 95 %
        confidence interval.
    rate : numpy.ndarray, shape (k, 3)
        Rate at which motions become quiet after LEAD cycles, per cycle, with the ends of its 95 %
        confidence interval; NaN if fewer than FEWEST motions last longer than LEAD. If the interval
        begins at 0, the chaos is an attractor, or a transient whose mean life exceeds the inverse
        of the upper end.
    """

    gaps: np.ndarray
    share: np.ndarray
    rate: np.ndarray


def find_lives(task, edge, limit, *, workers=1, progress=None) -> Lives:
    """Return the lives of chaotic motions at the gaps LIFE_GAPS on both sides of an edge.

    Parameters
    ----------
    task : Task
    edge : Edge
        Its `beyond` must be known.
    limit : float
        Quiet limit, mm.
    workers, progress
        As in `outcomes.run`.
    """
    outward = 1 if edge.beyond > edge.gap else -1
    gaps = edge.gap * np.array(LIFE_GAPS) ** outward
    cases = [Case(1e-3 * gap, edge.frequency) for gap in gaps]
    # By default a run stops once its motion is found chaotic. Here only the end of the run stops a
    # motion that does not settle, so that the end of a chaotic transient is seen.
    running = {"settling": task.lasting(LONGEST), "workers": workers, "progress": progress}
    records = run(task, cases, LIFE_STARTS, "lives", **running)
    sizes = task.millimetres(records["maximum_displacement"])
    quiet = are_quiet(sizes, records["outcome"], limit)
    settled = is_settled(records)
    lives = np.where(quiet & settled, records["periods_run"], LONGEST + 1)
    rates = []
    # A motion that becomes quiet without settling to an orbit is left out, because the time at
    # which it becomes quiet is unknown.
    for row, known in zip(lives, settled | ~quiet, strict=True):
        lasting = row[known]
        enough = np.sum(lasting > LEAD) >= FEWEST
        rates.append(escape_rate(lasting, LONGEST, LEAD) if enough else np.full(3, np.nan))
    shares = [wilson(count, LIFE_STARTS) for count in quiet.sum(axis=1)]
    return Lives(gaps, np.array(shares), np.array(rates))


class QuietBranch(NamedTuple):
    """A branch, the curve of the quiet orbits over one parameter.

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
    """Return the smallest quiet orbit to which starts lead at a gap (mm) and frequency (Hz).

    Return None if no start leads to a quiet orbit.
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
    """Return the branch of a quiet orbit over a parameter; None if `orbit` is None.

    Parameters
    ----------
    task : Task
    gap, frequency : float
        mm and Hz, of the orbit.
    orbit : Orbit or None
    parameter : str
        "clearance" (the branch follows its logarithm), "force" or "unbalance".
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
