"""Transients of a machine with and without its damper: a swept sine, and the unforced decay.

A continuous sweep is replaced by a stepped sweep, because the integrator needs a fixed frequency.
Cycle k of the stepped sweep has the mean frequency of cycle k of the continuous sweep.
"""

import math

import numpy as np
import xarray as xr
from scipy.special import ellipk

from impact_damper.data.datasets import flag
from impact_damper.design.task import labelled
from impact_damper.kernel.equation import energy
from impact_damper.model.families import FORCING
from impact_damper.model.machine import static_deflection
from impact_damper.model.packed import (
    CLEARANCE,
    CONTACT_STIFFNESS,
    CUBIC,
    FREQUENCY,
    FRICTION,
    GRAVITY,
    INVERSE_MASS_RATIO,
    STIFFNESS,
    cubic_spring,
    pack,
)
from impact_damper.motions.records import envelope

EQUIPMENT = ("bare", "damped")
TOLERANCE = 1e-10
# SWEEP: the rate of a sweep in Hz/s is SWEEP x (damping ratio x natural frequency in Hz)^2. At
# this rate the resonance peak of a linear machine is 6 % lower than in steady state.
# MOST_SWEPT: largest number of cycles in a sweep. If SWEEP gives more, the rate is raised.
SWEEP, MOST_SWEPT = 4.0, 6000
STEEPEST = 0.01  # largest relative change of the frequency in one cycle of a sweep
# Before each sweep, with or without the damper, the first frequency is held for the time in which a
# vibration of the machine alone would decay to SETTLED x its amplitude, but at most HELD cycles.
SETTLED, HELD = 0.01, 10**5
# An unforced decay is computed in windows of time. A window is one period of the machine's unforced
# vibration, but with a softening spring at most LONGEST periods of small vibrations. A decay begins
# at a displacement A. It ends when the energy of machine and loose mass is at most the energy of
# the machine alone at the displacement REST x A, or after MOST_WINDOWS windows.
REST, MOST_WINDOWS, LONGEST = 1e-3, 10**4, 2.0


def transients(task, choice, progress=None) -> xr.Dataset:
    """Return a dataset of sweeps and unforced decays, without and with the chosen damper."""
    machine, damper = task.machine, task.damper(1e-3 * float(choice["design_gap"]))
    # Only a sweep through all resonances meets all large motions of a nonlinear machine.
    low = min(task.band[0], task.resonance[0])
    high = max(task.band[1], task.resonance[1])
    decay_rate = machine.viscous_damping / (4 * np.pi * machine.mass)
    slowest = (high**2 - low**2) / 2 / MOST_SWEPT
    rate = min(max(SWEEP * decay_rate**2, slowest), STEEPEST * low**2)
    first = task.scales.to_si(1.0, "displacement")
    return swept_sine(machine, damper, (low, high), rate).merge(ring_down(machine, damper, first))


def swept_sine(machine, damper, band, rate) -> xr.Dataset:
    """Return a dataset of sweeps up and down over a band (Hz) at a rate (Hz/s).

    Each sweep begins in steady state. The envelope is the largest displacement in each cycle. If
    the motion escapes over the barrier of a softening spring, the envelope is infinite in the cycle
    of the escape, and NaN afterwards.
    """
    least, most = band
    count = int((most**2 - least**2) / (2 * rate))
    frequencies, sizes, status = [], [], []
    for first, slope in ((least, rate), (most, -rate)):
        _, turning = sweep_periods(first, slope, count)
        runs = [_swept(machine, each, first, turning) for each in (None, damper)]
        frequencies.append(turning)
        sizes.append([1e3 * run for run in runs])
        ends = ["completed" if np.isfinite(run[-1]) else "escaped" for run in runs]
        status.append([flag("sweep_status", end) for end in ends])
    values = {"sweep_frequency": frequencies, "sweep_envelope": sizes, "sweep_status": status}
    return labelled(values, direction=["up", "down"], equipment=list(EQUIPMENT))


def _swept(machine, damper, first, frequencies):
    decay_rate = machine.viscous_damping / (2 * machine.mass)
    held = min(math.ceil(-math.log(SETTLED) * first / decay_rate), HELD)
    rows = forced(machine, damper, np.concatenate([np.full(held, first), frequencies]))
    largest, _ = envelope(rows, 2 * np.pi / rows[:, FREQUENCY], np.zeros(4), TOLERANCE)
    return machine.scales.to_si(largest[held:], "displacement")


def sweep_periods(first, slope, count):
    """Return the beginning (s) and the mean frequency (Hz) of each cycle of a continuous sweep.

    At the time t the frequency is f0 + s t, and the phase in cycles is f0 t + s t^2/2. f0 (Hz) is
    `first`, s (Hz/s) is `slope`. Each of `count` cycles begins when this phase is a whole number.
    """
    phases = np.arange(count + 1)
    times = 2 * phases / (first + np.sqrt(first**2 + 2 * slope * phases))
    return times[:-1], 1 / np.diff(times)


def forced(machine, damper, frequencies):
    """Return packed parameters of machine and damper, a row for each of `frequencies` (Hz)."""
    scales = machine.scales
    scaled = None if damper is None else damper.scaled(scales)
    for end in (frequencies.max(), frequencies.min()):
        p = pack(machine.oscillator(), scaled, scales.from_si(end, "frequency"))
    rows = np.tile(p, (len(frequencies), 1))
    rows[:, FREQUENCY] = scales.from_si(frequencies, "frequency")
    return rows


def ring_down(machine, damper, displacement) -> xr.Dataset:
    """Return a dataset of unforced decays from a displacement (m), without and with the damper."""
    decays = [decay(machine, each, displacement) for each in (None, damper)]
    runs, status = zip(*decays, strict=True)
    padded = np.full((len(EQUIPMENT), max(map(len, runs)), 4), np.nan)
    for rows, run in zip(padded, runs, strict=True):
        rows[: len(run)] = run
    values = {
        "ring_time": padded[..., 0],
        "ring_envelope": 1e3 * padded[..., 2],
        "ring_status": [flag("ring_status", end) for end in status],
    }
    return labelled(values, equipment=list(EQUIPMENT))


def decay(machine, damper, displacement):
    """Return the unforced decay from a displacement (m) as an array, and a word for how it ended.

    A row is a window of time: its middle (s), inverse of its length (Hz), largest displacement (m),
    number of contacts. The word is "at_rest", "escaped", or "limit" after MOST_WINDOWS rows.
    """
    scales = machine.scales
    scaled = None if damper is None else damper.scaled(scales)
    oscillator = machine.oscillator()
    p = pack(oscillator, scaled, 1.0)
    p[list(FORCING.values())] = 0.0
    y = np.array([scales.from_si(displacement, "displacement"), 0.0, 0.0, 0.0])
    rest, rows, begin, end = energy.py_func(pack(oscillator, None, 1.0), REST * y), [], 0.0, "limit"
    while len(rows) < MOST_WINDOWS:
        left = energy.py_func(p, y) - lowest_energy(p, y)
        if left <= rest:
            end = "at_rest"
            break
        length = _window(p, left)
        (largest,), (contacts,) = envelope(p[None], np.array([length]), y, TOLERANCE)
        rows.append((begin + length / 2, 2 * np.pi / length, largest, contacts))
        if largest == np.inf:
            end = "escaped"
            break
        begin += length
    units = [scales.to_si(1.0, each) for each in ("time", "frequency", "displacement")]
    return np.array(rows) * [*units, 1.0], end


def lowest_energy(p, y) -> float:
    """Return the energy of machine and loose mass at rest, with the packed parameters `p`.

    The loose mass rests where friction holds it in the state `y`, or else where gravity puts it.
    """
    if not p[INVERSE_MASS_RATIO]:
        return 0.0
    weight = p[GRAVITY] / p[INVERSE_MASS_RATIO]
    x = -math.copysign(static_deflection(abs(weight), p[STIFFNESS], p[CUBIC]), weight)
    depth = abs(weight) / p[CONTACT_STIFFNESS]
    z = math.copysign(p[CLEARANCE] + depth, weight) if weight else 0.0
    z = y[2] if p[FRICTION] and y[3] == 0 else z
    return energy.py_func(p, [x, 0.0, z, 0.0])


def _window(p, left):
    stiffness, cubic = cubic_spring(p)
    period = unforced_period(stiffness, cubic, unforced_amplitude(stiffness, cubic, left))
    if cubic >= 0:
        return period
    return min(period, LONGEST * 2 * np.pi / np.sqrt(stiffness))


def unforced_amplitude(stiffness, cubic, stored) -> float:
    """Return the largest displacement A of an unforced vibration x(t) with the energy `stored`.

    Here x'' + a x + b x^3 = 0, where a is `stiffness` and b is `cubic`. The energy is
    a A^2/2 + b A^4/4. A is infinite if a softening spring cannot store this energy.
    """
    square = stiffness**2 + 4 * cubic * stored
    if square <= 0:
        return math.inf if stored > 0 else 0.0
    return 2 * math.sqrt(stored / (stiffness + math.sqrt(square)))


def unforced_period(stiffness, cubic, amplitude) -> float:
    """Return the period of an unforced vibration x(t) with the largest displacement A.

    Here x'' + a x + b x^3 = 0; a is `stiffness`, b is `cubic`, A is `amplitude`. With
    w^2 = a + b A^2 and m = b A^2/(2 w^2) the period is 4 K(m)/w, or infinite if w^2 <= 0. K is the
    complete elliptic integral of the first kind. (A. H. Nayfeh and D. T. Mook, Nonlinear
    Oscillations, 1979, section 2.1.)
    """
    square = stiffness + cubic * amplitude**2
    if square <= 0:
        return math.inf
    return 4 * float(ellipk(cubic * amplitude**2 / (2 * square))) / math.sqrt(square)
