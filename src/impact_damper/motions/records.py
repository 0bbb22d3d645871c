"""Measurements of motions: largest |Z1|, contacts, asymmetry, first harmonics, envelopes."""

import math

import numpy as np

from impact_damper.kernel.compiling import inlined, kernel, kernel_only
from impact_damper.kernel.equation import has_escaped
from impact_damper.kernel.instances import CONTACT_ORDER, FLIGHT_ORDER
from impact_damper.kernel.single import (
    X,
    assign,
    extremum,
    series_of_loose_mass,
    side_of,
    step,
    workspace,
)
from impact_damper.model.packed import FREQUENCY
from impact_damper.motions.strobe_map import STROBE, distance, speed_weight, strobe_time
from impact_damper.motions.traces import record_beginning

# PHASELESS: see `phase_of`. A motion is symmetric if its asymmetry is below SYMMETRIC.
PHASELESS = 1e-9
SYMMETRIC = 1e-6
# Number of samples in a forcing cycle from which harmonics are computed.
SAMPLES = 64
COSINE, SINE = (f(STROBE + 2 * np.pi * np.arange(SAMPLES) / SAMPLES) for f in (np.cos, np.sin))
# `envelope` runs this number of time windows in one call of a kernel. Ctrl-C waits for the call.
AT_ONCE = 1024
# The argument `stop` of a run that no other thread can stop.
NEVER = np.zeros(1, bool)
UNRESOLVED, SETTLED, CHAOTIC, DIVERGED, NON_COLLIDING = range(5)
ESCAPED, AT_REST, QUASI_PERIODIC, DRIFTING = range(5, 9)
# Fields of a record. A run fills the fields up to `state`. `measure` fills the other fields.
# period       period of the orbit in forcing cycles, 0 without an orbit
# periods_run  forcing cycles until the outcome was known
# residual     largest component of the difference between states a period apart
# reach        largest (Z1^2 + (Z1'/W)^2)^(1/2) at the strobes after settling.patience/2 cycles
# state        state at the strobe: on the orbit if settled, otherwise the last state of the run
WATCHED = "residual lyapunov_exponent lyapunov_error first_frequency second_frequency"
MEASURED = "maximum_displacement contacts asymmetry"
MOTION = np.dtype(
    [("outcome", "i1"), ("period", "i2"), ("periods_run", "i4"), ("multiplier", "c16")]
    + [(name, "f8") for name in f"{WATCHED} frequency_error reach".split()]
    + [("state", "f8", 4)]
    + [(name, "f8") for name in MEASURED.split()]
    + [("harmonic_displacement", "c16"), ("harmonic_relative", "c16")]
)


@kernel
def survey(p, states, phases, times, tolerance, log, sums):
    """Run a motion in m segments, one after the other; record contacts and first harmonics.

    `states` (m, 4) holds the first state of each segment; the segment's last state replaces it.
    `phases` and `times` (m + 1,) hold W T and T at which segments begin and end. `log` (n, 5)
    receives the first n contacts, in rows as in `traces.trace`. sums[0] receives the real and the
    imaginary part of the first harmonic of Z1, which is the mean of 2 exp(-i W T) Z1. sums[1]
    receives the first harmonic of Z2. Return the number of contacts and the largest |Z1|.
    """
    work, start = workspace(), np.empty(4)
    frequency, spacing = p[FREQUENCY], 2.0 * math.pi / SAMPLES
    sample = math.ceil((phases[0] - STROBE) / spacing)
    last = sample + round((phases[-1] - phases[0]) / spacing)
    weight, contacts, largest = 2.0 / (last - sample), 0, 0.0
    loose, apart = np.empty(CONTACT_ORDER + 1), spacing / frequency
    for i in range(2):
        sums[i, 0] = sums[i, 1] = 0.0
    for k in range(len(states)):
        y, t, end = states[k], times[k], times[k + 1]
        side, largest = side_of(p, y), max(largest, abs(y[0]))
        while t < end:
            assign(start, y)
            before = side
            order = FLIGHT_ORDER if side == 0 else CONTACT_ORDER
            length, side = step(p, y, side, t, end - t, tolerance, work)
            largest = extremum(work[X:], order, length, largest)
            ahead = end if length >= end - t else t + length
            series_of_loose_mass(work, before, start, loose)
            final = k == len(states) - 1 and ahead == end
            until = last if final else math.ceil((ahead * frequency - STROBE) / spacing)
            while sample < min(until, last):
                count = min(until - sample, last - sample, 4)
                first = (STROBE + sample * spacing) / frequency - t
                moments = first, first + apart, first + 2.0 * apart, first + 3.0 * apart
                add_samples(work[X:], order, moments, sample, count, sums[0])
                add_samples(loose, order, moments, sample, count, sums[1])
                sample += count
            t = ahead
            if before == 0 and side != 0:
                contacts = record_beginning(log, contacts, side, t, y[3])
            elif before != 0 and side == 0 and 0 < contacts <= len(log):
                log[contacts - 1, 2], log[contacts - 1, 4] = t, y[3]
    for i in range(2):
        sums[i, 0] *= weight
        sums[i, 1] *= -weight
    return contacts, largest


@kernel_only
def add_samples(c, order, moments, sample, count, sums):
    """Add samples of c(t) cos(W T) to sums[0], and samples of c(t) sin(W T) to sums[1].

    c is a polynomial of the degree `order` in the time t since the step began. Samples are taken at
    the first `count` of four times `moments`. `sample` is the index of the first, 0 at the strobe.
    """
    t0, t1, t2, t3 = moments
    v0 = v1 = v2 = v3 = c[order]
    for k in range(order - 1, -1, -1):
        v0, v1, v2, v3 = v0 * t0 + c[k], v1 * t1 + c[k], v2 * t2 + c[k], v3 * t3 + c[k]
    for j, value in enumerate((v0, v1, v2, v3)):
        if j < count:
            sums[0] += value * COSINE[(sample + j) % SAMPLES]
            sums[1] += value * SINE[(sample + j) % SAMPLES]


@inlined
def measure_orbit(p, periods, tolerance, out):
    """Measure an orbit over one period of `periods` forcing cycles. Complete its record `out`."""
    halves = 1 + periods % 2
    state = out.state.copy()
    y = state.copy().reshape(1, 4)
    log, sums = np.empty((0, 5)), np.empty((2, 2))
    phases, times = np.empty(2), np.empty(2)
    phases[1], times[1] = STROBE, strobe_time(p)
    largest, contacts, first, second = 0.0, 0, 0.0j, 0.0j
    for half in range(halves):
        phases[0], times[0] = phases[1], times[1]
        cycles = periods * (half + 1.0) / halves
        phases[1] = STROBE + cycles * 2.0 * math.pi
        times[1] = strobe_time(p) + cycles * (2.0 * math.pi / p[FREQUENCY])
        begun, most = survey(p, y, phases, times, tolerance, log, sums)
        contacts, largest = contacts + begun, max(largest, most)
        first += complex(sums[0, 0], sums[0, 1]) / halves
        second += complex(sums[1, 0], sums[1, 1]) / halves
        if half == 0 and halves == 2:
            out.asymmetry = distance(-y[0], state, speed_weight(p, side_of(p, y[0])))
    out.maximum_displacement = largest
    out.contacts = contacts / periods
    out.harmonic_displacement, out.harmonic_relative = first, second


@kernel
def measure_orbits(parameters, tolerance, out, stop):
    """Measure the orbits that the records `out` describe, and complete these records.

    An orbit is integrated over its period, from its state at the strobe. If the period is odd, the
    asymmetry is the distance between the mirrored first state and the state half a period later;
    otherwise it is NaN. A harmonic is the complex number c in Re(c exp(i W T)). A record with the
    period 0 receives infinite max |Z1|, and NaN for all other measurements. If another thread sets
    `stop[0]`, the remaining records are not completed.
    """
    nothing = complex(np.nan, np.nan)
    for i in range(len(out)):
        if stop[0]:
            break
        out[i].maximum_displacement, out[i].contacts, out[i].asymmetry = np.inf, np.nan, np.nan
        out[i].harmonic_displacement, out[i].harmonic_relative = nothing, nothing
        if out[i].period > 0:
            measure_orbit(parameters[i], np.int64(out[i].period), tolerance, out[i])


@kernel
def follow_each(parameters, states, cycles, tolerance, contacts, largest):
    """Run motions one after the other for `cycles` forcing cycles (see `ensemble.follow_many`)."""
    work = workspace()
    for i in range(len(states)):
        p, y = parameters[i], states[i]
        length = cycles * 2.0 * math.pi / p[FREQUENCY]
        _, largest[i], contacts[i] = run_window(
            p, y, side_of(p, y), length, abs(y[0]), tolerance, work
        )


def measure(parameters, settling, out, stop, follow=follow_each):
    """Measure motions from their states at the strobe; complete their records `out`.

    If a motion has no period, the kernel `follow` runs it for `settling.watched` cycles. Its record
    receives max |Z1| and the mean number of contacts in a cycle; other measurements are NaN.
    """
    measure_orbits(parameters, settling.tolerance, out, stop)
    watched = settling.watched
    others = np.flatnonzero((out["period"] == 0) & ~np.isin(out["outcome"], (DIVERGED, ESCAPED)))
    contacts, largest = np.zeros(len(others), np.int64), np.zeros(len(others))
    states = out["state"][others]
    follow(parameters[others], states, watched, settling.tolerance, contacts, largest)
    gone = np.isinf(largest)
    out["outcome"][others[gone]] = ESCAPED
    out["maximum_displacement"][others] = largest
    out["contacts"][others] = np.where(gone, np.nan, contacts / watched)


def measured(p, y, periods, tolerance):
    """Measure an orbit of a given period from its state y; return a record without outcome."""
    records = np.zeros(1, MOTION)
    records["state"], records["period"] = y, periods
    measure_orbits(p[None], tolerance, records, NEVER)
    return records[0]


def is_symmetric_pair(motions):
    """Return for each motion whether it is symmetric, of period 1, with two contacts in a cycle."""
    two = (motions["contacts"] == 2) & (motions["period"] == 1)
    return two & (motions["asymmetry"] < SYMMETRIC)


def phase_of(harmonic, reference):
    """Return arg(harmonic) - arg(reference), or NaN if |reference| <= PHASELESS |harmonic|."""
    phaseless = np.abs(reference) <= PHASELESS * np.abs(harmonic)
    return np.where(phaseless, np.nan, np.angle(harmonic * np.conj(reference)))


def tabulate(records):
    """Return the dataset variables of records, as a dict. `records` may have any shape."""
    first, second = records["harmonic_displacement"], records["harmonic_relative"]
    others = ("multiplier", "state", "reach", "harmonic_displacement", "harmonic_relative")
    return {name: records[name] for name in MOTION.names if name not in others} | {
        "phase_relative": phase_of(first, second),
        "phase_loose": phase_of(first, first - second),
        "multiplier_real": records["multiplier"].real,
        "multiplier_imaginary": records["multiplier"].imag,
    }


def envelope(parameters, lengths, y, tolerance):
    """Run a motion through n windows of time, with a row of packed parameters for each window.

    Return for each window the largest |Z1| and the number of contacts that begin. In the window of
    an escape |Z1| is infinite and the number is NaN; in later windows both are NaN.
    The last state replaces y. Each window begins at the strobe, where the forcing is 0, so W can
    change between windows. If there is forcing, each window must last one forcing cycle.
    """
    largest, contacts = np.full((2, len(lengths)), np.nan)
    side = side_of(next(iter(parameters)), y)
    for first in range(0, len(lengths), AT_ONCE):
        part = slice(first, first + AT_ONCE)
        out = largest[part], contacts[part]
        side = run_windows(parameters[part], lengths[part], y, side, tolerance, *out)
        if np.isinf(largest[part]).any():
            break
    return largest, contacts


@kernel_only
def run_window(p, y, side, length, largest, tolerance, work):
    """Run a motion from the strobe for a time `length`; the last state replaces y.

    Return three values: the wall in contact at the end; the larger of max |Z1| and `largest`, or
    infinity after an escape; and the number of contacts that begin.
    """
    t, begun = strobe_time(p), 0
    end = t + length
    while t < end:
        before = side
        taken, side = step(p, y, side, t, end - t, tolerance, work)
        order = FLIGHT_ORDER if before == 0 else CONTACT_ORDER
        largest = extremum(work[X:], order, taken, largest)
        begun += before == 0 and side != 0
        t = end if taken >= end - t else t + taken
    return side, math.inf if has_escaped(p, y[0], y[1]) else largest, begun


@kernel
def run_windows(parameters, lengths, y, side, tolerance, largest, contacts):
    """Run a motion through time windows, or to an escape. Return the wall in contact at the end."""
    work = workspace()
    for k in range(len(lengths)):
        side, largest[k], begun = run_window(
            parameters[k], y, side, lengths[k], abs(y[0]), tolerance, work
        )
        if largest[k] == math.inf:
            break
        contacts[k] = begun
    return side
