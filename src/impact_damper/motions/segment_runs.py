"""Kernels of multiple shooting, for orbits cut into chains of segments (`orbits.segments`)."""

import math

import numpy as np

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import (
    CONTACT_ORDER,
    FLIGHT_ORDER,
    Q,
    X,
    assign,
    polynomial,
    side_of,
    step,
    workspace,
)
from impact_damper.kernel.tangents import advance
from impact_damper.model.packed import CLEARANCE, COUNT, FREQUENCY
from impact_damper.motions.records import PIECES, SAMPLES, extremum, turning_time
from impact_damper.motions.strobe_map import STROBE
from impact_damper.motions.traces import record_beginning, series_of_step

# NUDGE       change of the parameter forward and backward in the central difference
# BENT        largest difference of the forward and the backward difference, divided by their sum.
#             If it is larger, a contact has appeared or vanished within the change.
# FINE_NUDGE  change of the parameter in this case
NUDGE, FINE_NUDGE, BENT = 2e-7, 1e-9, 1e-3


@kernel
def survey(p, states, phases, tolerance, log, sums):
    """Record contacts, the largest |Z1| and first harmonics of a motion in segments.

    `states` (m, 4) at the beginnings of the segments are replaced by the states at their ends;
    `phases` (m + 1,) are W T at the beginnings and at the last end. `log` (n, 5) receives the first
    n contacts, as from `traces.trace`; `sums` (2, 2) real and imaginary part of the mean of 2
    exp(-i W T) Z1 and 2 exp(-i W T) Z2, from SAMPLES samples in a forcing cycle. Return the number
    of contacts and the largest |Z1|.
    """
    work, start = workspace(), np.empty(4)
    frequency, spacing = p[FREQUENCY], 2.0 * math.pi / SAMPLES
    sample = math.ceil((phases[0] - STROBE) / spacing)
    last = sample + round((phases[-1] - phases[0]) / spacing)
    weight, contacts, largest = 2.0 / (last - sample), 0, 0.0
    for i in range(2):
        sums[i, 0] = sums[i, 1] = 0.0
    for k in range(len(states)):
        y, t, end = states[k], phases[k] / frequency, phases[k + 1] / frequency
        side, largest = side_of(p, y), max(largest, abs(y[0]))
        while t < end:
            assign(start, y)
            before = side
            order = FLIGHT_ORDER if side == 0 else CONTACT_ORDER
            length, side = step(p, y, side, t, end - t, tolerance, work)
            largest = extremum(work[X:], order, length, largest)
            ahead = end if length >= end - t else t + length
            final = k == len(states) - 1 and ahead == end
            while sample < last and (final or STROBE + sample * spacing < ahead * frequency):
                phase = STROBE + sample * spacing
                x, _, z, _ = series_of_step(work, before, start, phase / frequency - t)
                z += before * p[CLEARANCE] if before != 0 else 0.0
                cosine, sine = weight * math.cos(phase), weight * math.sin(phase)
                sums[0, 0] += x * cosine
                sums[0, 1] -= x * sine
                sums[1, 0] += z * cosine
                sums[1, 1] -= z * sine
                sample += 1
            t = ahead
            if before == 0 and side != 0:
                contacts = record_beginning(log, contacts, side, t, y[3])
            elif before != 0 and side == 0 and contacts <= len(log):
                log[contacts - 1, 2], log[contacts - 1, 4] = t, y[3]
    return contacts, largest


@kernel
def list_turns(p, states, phases, tolerance, turns):
    """List the extrema of Z2 of a motion in segments (see `survey`); return their number.

    `turns` (n, 4) receives a row for each of the first n: segment, phase W T, 1 for a maximum of
    |Z2| or 0 for a minimum, and |Z2| minus the clearance.
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
            order, first = (FLIGHT_ORDER, X) if side == 0 else (CONTACT_ORDER, Q)
            length, side = step(p, y, side, t, end - t, tolerance, work)
            for i in range(order + 1):
                c[i] = work[first + i]
            if before == 0:
                c[0] += start[2] - start[0]
                c[1] += start[3] - start[1]
            else:
                c[0] += before * p[CLEARANCE]
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
    """Integrate all segments of a chain between `times` (m + 1,); return the time in contact.

    States (m, 4) and tangents (m, 0 or 4, 4) are replaced by those at the ends.
    """
    work, touching = workspace(), 0.0
    for k in range(len(states)):
        side = side_of(p, states[k])
        begin, end = times[k], times[k + 1]
        _, _, time = advance(p, states[k], tangents[k], side, begin, end, tolerance, work)
        touching += time
    return touching


@kernel
def slopes_of_ends(p, rate, phases, states, ends, sign, tolerance, slopes):
    """Compute the derivatives of the ends of segments by a parameter, as central differences.

    `rate` (COUNT,) are the derivatives of the packed parameters by it; `sign` is -1 if the segments
    cover half a symmetric orbit, else 1, and multiplies the last end. `slopes` (m, n) receives the
    derivatives of the first n components, n = 2 without a damper or 4 with one. `phases` (m + 1,),
    `states` and `ends` (m, 4) are as in `orbits.segments.Chain`.
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
