"""The choice of the gap, and the cliff: gaps at which starts cease to lead to quiet motions.

With a contact that loses energy the quiet orbit is smallest close to the gap at which it loses its
stability. At this gap hardly any start leads to the orbit, but at a smaller gap all starts do.
Between the two gaps the share of quiet starts falls from 1 to nearly 0 while the gap grows by a few
per cent: this is the cliff. The other starts lead to chaos, which is a transient or lasts for good.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr

from impact_damper.data.datasets import flag, is_settled
from impact_damper.data.shares import BOUNDS, escape_rate
from impact_damper.design.choose import choose, middle_gap, quiet_gaps
from impact_damper.design.compare import compare
from impact_damper.design.deviations import choose_with_tolerances
from impact_damper.design.outcomes import Case, quiet_motions, run
from impact_damper.design.task import SIDES, labelled

# Bisections between two compared gaps, of which only one is quiet, and number of frequencies at
# which a gap is then tested: those with the smallest shares of quiet starts.
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


class Edge(NamedTuple):
    """An end of the range of quiet gaps.

    `gap` is the last gap known to be quiet and `beyond` the first known not to be, mm. `frequency`
    (Hz) is that of the smallest share of quiet starts at `beyond`.
    """

    gap: float
    beyond: float
    status: int
    frequency: float


NO_EDGE = Edge(np.nan, np.nan, flag("cliff_status", "no_quiet_gap"), np.nan)


def choose_gap(task, compared, progress=None) -> xr.Dataset:
    """Return the chosen gap, the ends of the quiet gaps around it, and lives of chaos beyond them.

    `compared` is the dataset of `compare.compare_gaps`. The later steps of the design read gap,
    quiet limit and critical frequency from the dataset returned: the frequency at which the cliff
    is met first or, without a cliff, at which the machine without damper moves most.
    """
    limit = float(compared["displacement_limit"])
    choice, edges = choose_with_edges(task, compared, progress)
    known = [edge for edge in reversed(edges) if np.isfinite(edge.frequency)]
    values = {
        "design_gap": choice.gap,
        "design_choice": flag("design_choice", choice.kind),
        "displacement_limit": limit,
        "branch_frequency": known[0].frequency if known else task.worst_frequency,
        "cliff_gap": [edge.gap for edge in edges],
        "cliff_beyond": [edge.beyond for edge in edges],
        "cliff_status": [edge.status for edge in edges],
        "cliff_frequency": [edge.frequency for edge in edges],
    }
    found = labelled(values, side=SIDES)
    return found.merge(find_lives(task, known[0], limit, progress)) if known else found


def find_edges(task, compared, gap) -> tuple[Edge, Edge]:
    """Return the lower and the upper end of the range of quiet gaps around a gap (mm).

    The comparison brackets each end between two gaps. Each bracket is bisected, with all starts at
    the frequencies with the smallest shares of quiet starts.
    """
    gaps, quiet = compared["candidate_gap"].values, quiet_gaps(compared, task.share)
    inner = np.flatnonzero(quiet)
    if len(inner) == 0:
        return NO_EDGE, NO_EDGE
    k = inner[np.argmin(np.abs(np.log(gaps[inner] / gap)))]
    found = []
    for step in (-1, 1):
        last = k
        while 0 <= last + step < len(quiet) and quiet[last + step]:
            last += step
        if not 0 <= last + step < len(quiet):
            ends = flag("cliff_status", "range_ends")
            found.append(Edge(float(gaps[last]), np.nan, ends, np.nan))
        else:
            found.append(_bisect(task, compared, last, last + step))
    return tuple(found)


def _bisect(task, compared, last, beyond):
    """Return the edge between the quiet gap of index `last` and its neighbour `beyond`."""
    shares = compared["start_quiet_share"].values[beyond]
    order = np.argsort(shares, kind="stable")[:CRITICAL]
    critical = compared["frequency"].values[order]
    inside, outside = compared["candidate_gap"].values[[last, beyond]]
    limit = float(compared["displacement_limit"])
    for _ in range(BISECTIONS):
        middle = np.sqrt(inside * outside)
        found = compare(task, [middle], critical, limit, task.effort.starts, "edges")
        if quiet_gaps(found, task.share)[0]:
            inside = middle
        else:
            outside = middle
    return Edge(float(inside), float(outside), flag("cliff_status", "found"), float(critical[0]))


def choose_with_edges(task, compared, progress=None):
    """Return the `choose.Choice` of a gap, and the two edges of the quiet gaps around it.

    A range that is too narrow to hold a gap in it is left out, and the choice is made again.
    """
    while True:
        choice = choose(compared, task.share, task.gap_tolerance)
        choice = choose_with_tolerances(task, compared, choice, progress)
        edges = find_edges(task, compared, choice.gap)
        if choice.kind != "needs_tolerance":
            return choice, edges
        if can_be_held(edges, task.gap_tolerance):
            limit = float(compared["displacement_limit"])
            return _recentred(task, choice, edges, limit), edges
        low, high = (edge.gap for edge in edges)
        gaps = compared["candidate_gap"].values
        compared = compared.isel(candidate=(gaps < low) | (gaps > high))


def can_be_held(edges, tolerance) -> bool:
    """Return whether a gap can be kept between two edges by a builder, see HOLDABLE."""
    low, high = (edge.gap for edge in edges)
    return high - low >= min(HOLDABLE, 2 * tolerance) * np.sqrt(low * high)


def _recentred(task, choice, edges, limit):
    """Return the choice, moved to the middle of a narrow range of quiet gaps if that is quiet."""
    gap = middle_gap(*(edge.gap for edge in edges))
    found = compare(task, [gap], task.grid, limit, task.effort.starts, "middle")
    return choice._replace(gap=gap) if quiet_gaps(found, task.share)[0] else choice


def find_lives(task, edge, limit, progress=None) -> xr.Dataset:
    """Return the rates at which chaotic motions become quiet, at gaps on both sides of an edge.

    A rate is NaN if fewer than FEWEST motions last longer than LEAD. If its interval begins at 0,
    the chaos is an attractor, or a transient of a mean life above the inverse of the upper end.
    """
    outward = 1 if edge.beyond > edge.gap else -1
    gaps = edge.gap * np.array(LIFE_GAPS) ** outward
    cases = [Case(1e-3 * gap, edge.frequency) for gap in gaps]
    # By default a run stops once its motion is found chaotic. Here only the end of the run stops a
    # motion that does not settle, so that the end of a chaotic transient is seen.
    settling = task.effort.lasting(LONGEST)
    records = run(task, cases, LIFE_STARTS, "lives", settling=settling, progress=progress)
    quiet, settled = quiet_motions(task, records, limit), is_settled(records)
    lives = np.where(quiet & settled, records["periods_run"], LONGEST + 1)
    rates = []
    # A motion that becomes quiet without settling to an orbit is left out, because the time at
    # which it becomes quiet is unknown.
    for row, known in zip(lives, settled | ~quiet, strict=True):
        lasting = row[known]
        enough = np.sum(lasting > LEAD) >= FEWEST
        rates.append(escape_rate(lasting, LONGEST, LEAD) if enough else np.full(3, np.nan))
    return labelled({"life_rate": rates}, life_gap=gaps, bound=BOUNDS)
