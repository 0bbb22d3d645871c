"""Measurements of motions: largest |Z1|, contacts, harmonics, first collisions, envelopes.

A record is an element of an array of the type MOTION. It holds the results for one motion.
"""

import math

import numpy as np

from impact_damper.kernel.compiling import inlined, kernel, kernel_only
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER
from impact_damper.kernel.single import X, assign, polynomial, side_of, step, workspace
from impact_damper.model.packed import CLEARANCE, FREQUENCY
from impact_damper.motions.strobe_map import distance, speed_weight, strobe_time
from impact_damper.motions.traces import series_of_step

# A harmonic below PHASELESS times the harmonic of Z1 is a rounding error, so it has no phase.
PHASELESS = 1e-9
# Number of samples in a forcing cycle, from which harmonics are computed.
SAMPLES = 64
# Number of pieces of an interval. In each piece a polynomial is assumed to have at most one turning
# point.
PIECES = 8
# Number of windows of an envelope in one call of the kernel. Ctrl-C waits for the end of a call.
AT_ONCE = 1024
# Argument `stop` of runs that no other thread stops.
NEVER = np.zeros(1, bool)

# Outcomes of a motion that is run until it settles.
(
    UNRESOLVED,
    SETTLED,
    CHAOTIC,
    DIVERGED,
    NON_COLLIDING,
    ESCAPED,
    AT_REST,
    QUASI_PERIODIC,
    DRIFTING,
) = range(9)
# `watch.watch` fills the fields from `outcome` to `reach`, and `measure` the other fields. Some
# fields:
# period           period of the orbit in forcing cycles, 0 without an orbit
# periods_run      forcing cycles until the outcome was known
# multiplier       dominant Floquet multiplier of the orbit
# residual         largest difference between the state and the state a period later
# first_frequency, second_frequency: the two frequencies of a quasi-periodic motion
# frequency_error  error of second_frequency
# state            last state at the strobe, of a settled motion the state on the orbit
# reach            largest (Z1^2 + (Z1'/W)^2)^(1/2) at a strobe after the first patience/2 cycles
MOTION = np.dtype(
    [
        ("outcome", "i1"),
        ("period", "i2"),
        ("periods_run", "i4"),
        ("multiplier", "c16"),
        ("residual", "f8"),
        ("lyapunov_exponent", "f8"),
        ("lyapunov_error", "f8"),
        ("first_frequency", "f8"),
        ("second_frequency", "f8"),
        ("frequency_error", "f8"),
        ("state", "f8", 4),
        ("reach", "f8"),
        ("maximum_displacement", "f8"),
        ("contacts", "f8"),
        ("asymmetry", "f8"),
        ("harmonic_displacement", "c16"),
        ("harmonic_relative", "c16"),
    ]
)


@kernel
def extremum(c, order, length, start):
    """Return the largest |polynomial| over [0, length], or `start` if `start` is larger.

    The polynomial exceeds the larger of its values at the two ends by at most length^2/8 times a
    bound on its second derivative, which in most calls shows that `start` or an end is largest.
    Otherwise Newton's method locates the turning point in each of PIECES pieces.
    """
    low, fall = polynomial(c, order, 0.0)
    high, _ = polynomial(c, order, length)
    excess, power = 0.0, length
    for k in range(2, order + 1):
        power *= length
        excess += 0.125 * k * (k - 1) * abs(c[k]) * power
    best = max(start, max(abs(low), abs(high)))
    if max(abs(low), abs(high)) + excess <= best:
        return best
    for piece in range(1, PIECES + 1):
        t = length * piece / PIECES
        value, slope = polynomial(c, order, t)
        best = max(best, abs(value))
        # The modulus increases at the beginning of the piece and decreases at its end.
        if slope * fall < 0.0 and value * slope < 0.0:
            turn = turning_time(c, order, t - length / PIECES, t, fall, slope)
            best = max(best, abs(polynomial(c, order, turn)[0]))
        fall = slope
    return best


@kernel_only
def turning_time(c, order, begin, end, first, last):
    """Return the turning point of a polynomial between two times, from the slopes there."""
    t = begin + (end - begin) * first / (first - last)
    for _ in range(4):
        _, slope = polynomial(c, order, t)
        bend = 0.0
        for k in range(order, 1, -1):
            bend = bend * t + k * (k - 1) * c[k]
        if bend == 0.0:
            break
        t = min(max(t - slope / bend, begin), end)
    return t


@inlined
def measure_one(p, y, periods, tolerance, out, stop):
    """Do the same as `measure` for one motion and a given number of forcing cycles."""
    work = workspace()
    period = 2.0 * math.pi / p[FREQUENCY]
    begin = strobe_time(p)
    end = begin + periods * period
    spacing = period / SAMPLES
    start = y.copy()
    state = y.copy()
    half = begin + 0.5 * periods * period if periods % 2 == 1 else math.inf
    side = side_of(p, y)
    largest, contacts, t, sample = abs(y[0]), 0, begin, 0
    first, second = 0.0j, 0.0j
    out.asymmetry = np.nan
    while t < end and not stop[0]:
        ahead = min(end, half) if t < half else end
        assign(start, state)
        before = side
        length, side = step(p, state, side, t, ahead - t, tolerance, work)
        order = FLIGHT_ORDER if before == 0 else CONTACT_ORDER
        largest = extremum(work[X:], order, length, largest)
        contacts += before == 0 and side != 0
        while begin + sample * spacing < t + length and sample < periods * SAMPLES:
            x, _, z, _ = series_of_step(work, before, start, begin + sample * spacing - t)
            z += before * p[CLEARANCE] if before != 0 else 0.0
            angle = p[FREQUENCY] * (begin + sample * spacing)
            turn = complex(math.cos(angle), -math.sin(angle))
            first += x * turn
            second += z * turn
            sample += 1
        t = ahead if length >= ahead - t else t + length
        if t == half:
            out.asymmetry = distance(-state, y, speed_weight(p, side))
    if has_escaped(p, state[0], state[1]):
        measure_nothing(out)
        out.outcome = ESCAPED
        return
    out.maximum_displacement = largest
    out.contacts = contacts / periods
    out.harmonic_displacement = first * (2.0 / sample)
    out.harmonic_relative = second * (2.0 / sample)


@inlined
def measure_nothing(out):
    """Fill the measurements of a motion that diverges or escapes."""
    out.maximum_displacement = np.inf
    out.contacts, out.asymmetry = np.nan, np.nan
    out.harmonic_displacement, out.harmonic_relative = (
        complex(np.nan, np.nan),
        complex(np.nan, np.nan),
    )


@kernel
def measure(parameters, tolerance, watched, out, stop):
    """Complete the records `out` by measurements that begin at their states at the strobe.

    A motion is integrated over its `period`, or over `watched` forcing cycles if its period is 0.
    One that has diverged or escaped gets an infinite displacement. Asymmetry is the distance
    between the mirrored first state and the state after half the measured time, NaN for an even
    number of cycles. The harmonics are complex amplitudes c of Re(c exp(i W T)), from SAMPLES
    samples in a forcing cycle. When another thread sets `stop[0]`, the remaining records are not
    completed.
    """
    for i in range(len(out)):
        if out[i].outcome == DIVERGED or out[i].outcome == ESCAPED:
            measure_nothing(out[i])
        else:
            periods = out[i].period if out[i].period > 0 else watched
            measure_one(parameters[i], out[i].state.copy(), periods, tolerance, out[i], stop)


def measured(p, y, periods, tolerance):
    """Return a record with the fields of `measure` only, measured from y over `periods` cycles."""
    records = np.zeros(1, MOTION)
    records["state"] = y
    measure(p[None], tolerance, periods, records, NEVER)
    return records[0]


def phase_of(harmonic, reference):
    """Return the phases (radian) of harmonics relative to the phases of `reference`.

    The phase is NaN where `reference` is a rounding error (PHASELESS).
    """
    phaseless = np.abs(reference) <= PHASELESS * np.abs(harmonic)
    return np.where(phaseless, np.nan, np.angle(harmonic * np.conj(reference)))


def tabulate(records):
    """Return the registered variables, keyed by name, for an array of records of any shape."""
    first, second = records["harmonic_displacement"], records["harmonic_relative"]
    others = ("multiplier", "state", "reach", "harmonic_displacement", "harmonic_relative")
    return {name: records[name] for name in MOTION.names if name not in others} | {
        "phase_relative": phase_of(first, second),
        "phase_loose": phase_of(first, first - second),
        "multiplier_real": records["multiplier"].real,
        "multiplier_imaginary": records["multiplier"].imag,
    }


def envelope(parameters, lengths, y, tolerance):
    """Run a motion through windows of time (n,), each with its packed parameters (n, COUNT).

    Return the largest |Z1| and the number of contacts begun in each window; where the motion
    escapes they are infinite and NaN, afterwards NaN. The state y is replaced by the last one. The
    kernel of a step requires a fixed frequency, so in a sweep it changes at the strobe, where the
    force is zero: each window begins at the strobe, and with forcing its length is a forcing cycle.
    """
    largest, contacts = np.full((2, len(lengths)), np.nan)
    side = side_of(next(iter(parameters)), y)
    for first in range(0, len(lengths), AT_ONCE):
        part = slice(first, first + AT_ONCE)
        side, escaped = run_windows(
            parameters[part], lengths[part], y, side, tolerance, largest[part], contacts[part]
        )
        if escaped:
            break
    return largest, contacts


@kernel
def run_windows(parameters, lengths, y, side, tolerance, largest, contacts):
    """Fill `largest` and `contacts` of `envelope`.

    Return the wall in contact, and whether the motion escaped.
    """
    work = workspace()
    for k in range(len(lengths)):
        p = parameters[k]
        t = strobe_time(p)
        end = t + lengths[k]
        farthest, begun = abs(y[0]), 0
        while t < end:
            before = side
            length, side = step(p, y, side, t, end - t, tolerance, work)
            if has_escaped(p, y[0], y[1]):
                largest[k] = np.inf
                return side, True
            order = FLIGHT_ORDER if before == 0 else CONTACT_ORDER
            farthest = extremum(work[X:], order, length, farthest)
            begun += before == 0 and side != 0
            t = end if length >= end - t else t + length
        largest[k], contacts[k] = farthest, begun
    return side, False


@kernel
def follow_peaks(parameters, states, periods, tolerance, largest, stop):
    """Run motions in place from a strobe, and raise `largest` to the largest |Z1| of each.

    It is infinite after an escape. If another thread sets `stop[0]`, the numbers are incomplete.
    """
    work = workspace()
    for i in range(len(states)):
        p, y = parameters[i], states[i].copy()
        side = side_of(p, y)
        for _ in range(periods):
            if stop[0] or largest[i] == math.inf:
                break
            t = strobe_time(p)
            end = t + 2.0 * math.pi / p[FREQUENCY]
            while t < end:
                before = side
                length, side = step(p, y, side, t, end - t, tolerance, work)
                order = FLIGHT_ORDER if before == 0 else CONTACT_ORDER
                largest[i] = extremum(work[X:], order, length, largest[i])
                t = end if length >= end - t else t + length
            if has_escaped(p, y[0], y[1]):
                largest[i] = math.inf
        assign(states[i], y)
