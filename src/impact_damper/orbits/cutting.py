"""Cut the orbits of a branch into new segments where the old ones no longer fit.

A branch is the curve of the periodic orbits over a parameter. In multiple shooting an orbit is cut
into segments at phases called sections. Along a branch contacts move, and segments amplify
disturbances more. A section must stay clear of contacts, and a segment must amplify little, so that
the residual of the orbit can become small.
"""

from dataclasses import replace

import numpy as np

from impact_damper.motions.segment_runs import FINE_NUDGE
from impact_damper.orbits import segments
from impact_damper.orbits.orbit import TURN
from impact_damper.orbits.shooting import AMPLIFYING

# An orbit is cut into new segments in three cases.
# NEAR_SECTION: a contact is closer to a section than this (radian).
# ROUGHER: a segment amplifies more than this factor times the largest amplification of a segment
#   when the orbit was cut.
# MILD: the whole orbit amplifies less than MILD * AMPLIFYING. It then becomes a single segment.
NEAR_SECTION, ROUGHER, MILD = 0.02, 4.0, 0.5


def holds_still(point):
    """Return whether the segments of a point can be kept (see NEAR_SECTION)."""
    problem, orbit = point.problem, point.orbit
    if not problem.damped:
        return True
    if len(problem.phases) == 2 and problem.rough == 0:
        return orbit.amplification <= AMPLIFYING and orbit.flight_phase() == orbit.phase
    mild = orbit.amplification < MILD * AMPLIFYING
    still = np.max(_norms(orbit)) < ROUGHER * problem.rough
    return bool(not mild and still and np.min(orbit.margin(problem.phases[:-1])) > NEAR_SECTION)


def recut(point, between=()):
    """Return a point with new segments, or the same point if Newton's method fails with them.

    The new unknowns are the states at the new sections. Their tangent points to the states there
    of a motion that begins at a point displaced along the old tangent. `between` is the argument of
    `segments.cut`.
    """
    before, orbit = point.problem, point.orbit
    phases, rough = segments.cut(orbit, before.cycle, between), 1.0
    if not between and orbit.amplification <= AMPLIFYING:
        phases, rough = orbit.flight_phase() + np.array([0.0, before.cycle]), 0.0
    problem = replace(before, phases=phases - phases[0] + phases[0] % TURN, rough=rough)
    x = np.append([orbit.at(phase) for phase in phases[:-1]], point.x[-1])
    nudged = point.x + FINE_NUDGE * point.tangent
    p, states = before.family(nudged[-1]), before.states(nudged)
    if orbit.chain is None:
        displaced = replace(orbit, p=p, state=states[0])
    else:
        displaced = replace(orbit.chain, p=p, states=states)
    ahead = np.append([displaced.at(phase) for phase in phases[:-1]], nudged[-1])
    border = (ahead - x) / problem.length(ahead - x)
    moved = problem.correct(x, border)
    if moved is None:
        return point
    problem = replace(problem, rough=np.max(_norms(moved.orbit)) if rough else 0.0)
    return moved._replace(problem=problem)


def _norms(orbit):
    """Return the Frobenius norms of the derivatives of the m segments of an orbit, shape (m,)."""
    return np.sqrt(np.sum(orbit.factors**2, axis=(1, 2)))
