"""Kernels of multiple shooting, for orbits that are divided into segments (`orbits.segments`)."""

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import (
    CONTACT_ORDER,
    FLIGHT_ORDER,
    assign,
    polynomial,
    series_of_loose_mass,
    side_of,
    step,
    workspace,
)
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, COUNT, FREQUENCY
from impact_damper.motions.records import PIECES, turning_time

# Central difference: change of the parameter; finer change where a contact appears or vanishes;
# ratio of the difference of the one-sided differences to their sum that shows such a contact.
NUDGE, FINE_NUDGE, BENT = 2e-7, 1e-9, 1e-3


@kernel
def list_turns(p, states, phases, tolerance, turns):
    """List the extrema of Z2 of a motion in segments (see `survey`); return their number.

    The columns of `turns` (n, 4) are the segment; the phase W T; 1 at a maximum of |Z2|, 0 at a
    minimum; and |Z2| minus the clearance.
    """
    work, start = workspace(), np.empty(4)
    c = np.empty(max(FLIGHT_ORDER, CONTACT_ORDER) + 1)
    count = 0
    for k in range(len(states)):
        y, t, end = states[k], phases[k] / p[FREQUENCY], phases[k + 1] / p[FREQUENCY]
        side = side_of(p, y)
        while t < end:
            assign(start, y)
            before = side
            length, side = step(p, y, side, t, end - t, tolerance, work)
            order = series_of_loose_mass(work, before, start, c)
            _, begun = polynomial(c, order, 0.0)
            for piece in range(1, PIECES + 1):
                place = length * piece / PIECES
                _, slope = polynomial(c, order, place)
                if begun * slope <= 0.0 and begun != slope:
                    turn = turning_time(c, order, place - length / PIECES, place, begun, slope)
                    if count < len(turns):
                        turns[count, 0], turns[count, 1] = k, (t + turn) * p[FREQUENCY]
                        value, _ = polynomial(c, order, turn)
                        turns[count, 2] = 1.0 if value * (begun - slope) > 0.0 else 0.0
                        turns[count, 3] = abs(value) - p[CLEARANCE]
                    count += 1
                begun = slope
            t = end if length >= end - t else t + length
    return count


@kernel
def flow_all(p, states, tangents, times, tolerance):
    """Integrate m states and their tangents (m, 0 or 4, 4) in place; return the time in contact."""
    work, touching = workspace(), 0.0
    for k in range(len(states)):
        side = side_of(p, states[k])
        begin, end = times[k], times[k + 1]
        _, _, time = advance(p, states[k], tangents[k], side, begin, end, tolerance, work)
        touching += time
    return touching


@kernel
def slopes_of_ends(p, rate, phases, states, ends, sign, tolerance, slopes):
    """Compute the derivatives of the end states of segments by a parameter (central differences).

    `rate` (COUNT,) holds the derivatives of the packed parameters by this parameter. `sign` is -1
    if the segments cover half a symmetric orbit. `slopes` (m, n) receives the first n components.
    """
    work, none = workspace(), np.empty((0, 4))
    ahead, behind, moved = np.empty(4), np.empty(4), np.empty(COUNT)
    m, n = slopes.shape
    for k in range(m):
        for nudge in (NUDGE, FINE_NUDGE):
            for way in (1.0, -1.0):
                y = ahead if way > 0.0 else behind
                assign(y, states[k])
                for i in range(COUNT):
                    moved[i] = p[i] + way * nudge * rate[i]
                begin, end = phases[k] / moved[FREQUENCY], phases[k + 1] / moved[FREQUENCY]
                advance(moved, y, none, side_of(moved, y), begin, end, tolerance, work)
            whole, bend = 0.0, 0.0
            for i in range(n):
                whole = max(whole, abs(ahead[i] - behind[i]))
                bend = max(bend, abs(ahead[i] + behind[i] - 2.0 * ends[k, i]))
                slopes[k, i] = (ahead[i] - behind[i]) / (2.0 * nudge)
            if bend <= BENT * whole or not p[CLEARANCE] < np.inf:
                break
    for i in range(n):
        slopes[m - 1, i] *= sign
