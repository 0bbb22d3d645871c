"""A swept sine, up and down, on a machine with its damper and without.

The forcing frequency changes at a constant rate. The kernel takes a fixed frequency, so each
forcing period has its mean frequency in the continuous sweep. Periods then begin and end when those
of the sweep do; within a period the phase differs by at most pi/4 of the share by which the
frequency changes in it.
"""

import json
import math

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.machine.machine import check_fit
from impact_damper.machine.results import in_si
from impact_damper.machine.units import check_si
from impact_damper.motions.envelopes import envelope
from impact_damper.system.bounds import shown
from impact_damper.system.packed import FORCE, FREQUENCY, UNBALANCE, pack

DIRECTIONS = ("up", "down")
EQUIPMENT = ("bare", "damped")
# Local error allowed.
TOLERANCE = 1e-10
# Largest share by which the frequency may change in a forcing period, and most forcing periods.
STEEPEST = 0.01
MOST_PERIODS = 10**6
# The first frequency is held until the machine's own transients, without the damper, have fallen to
# the share SETTLED, and at most for HELD forcing periods.
SETTLED = 0.01
HELD = 10**5


def swept_sine(machine, damper, band, rate):
    """Sweep the forcing frequency of a machine up and down, with its damper and without.

    A sweep starts from rest, with the loose mass in the middle of its gap, and the first frequency
    is held until the machine's own transients have died away. The resonance peak of a lightly
    damped linear machine is then lower than in steady state, by 1 % at the rate
    (damping ratio x natural frequency)^2 and by 6 % at four times this rate.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
        With a contact stiffness.
    band : sequence of 2 floats
        Least and greatest frequency, Hz.
    rate : float
        Change of the frequency per time, Hz/s, above 0; at most 1 % in a forcing period.

    Returns
    -------
    xarray.Dataset
        In SI units, one window for each forcing period. `time` from the end of the hold to the
        middle of the window, and `frequency`, both (direction, window); `envelope` and
        `window_contacts` (direction, equipment, window), from an escape on infinite, then NaN;
        `transient_status` (direction, equipment): completed or escaped. The attribute `sweep` holds
        band, rate and the forcing periods for which the first frequency was held.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    check_fit(machine, damper)
    least, most, rate = _check_sweep(machine, band, rate)
    count = int((most**2 - least**2) / (2 * rate))
    ends = ((least, rate), (most, -rate))
    found = [_sweep(machine, damper, first, slope, count) for first, slope in ends]
    times, frequencies, runs, held = zip(*found, strict=True)
    largest, contacts, status = (
        np.array([[run[k] for run in both] for both in runs]) for k in range(3)
    )
    each = ("direction", "equipment", "window")
    data = {
        "time": (("direction", "window"), np.array(times)),
        "frequency": (("direction", "window"), np.array(frequencies)),
        "envelope": (each, largest),
        "window_contacts": (each, contacts),
        "transient_status": (each[:2], status),
    }
    coordinates = {"direction": list(DIRECTIONS), "equipment": list(EQUIPMENT)}
    found = in_si(
        dataset(data, coordinates, {"tolerance": TOLERANCE}, "Swept sine"), machine, damper
    )
    made = {"band": [least, most], "rate": rate, "held": held}
    return found.assign_attrs(sweep=json.dumps(made, sort_keys=True))


def _check_sweep(machine, band, rate):
    """Return least and greatest frequency, Hz, and rate, Hz/s, or raise."""
    if np.ndim(band) != 1 or len(band) != 2:
        raise ValueError(f"band = {shown(band)}: must be least and greatest frequency")
    least, most = (machine.check_frequency(f"band[{i}]", band[i]) for i in range(2))
    if least >= most:
        raise ValueError(f"band = {shown(band)}: must be least and greatest frequency")
    check_si("rate", rate, "sweep_rate", above=0)
    why = f"{100 * STEEPEST:g} % of band[0] in a forcing period"
    check_si("rate", rate, "sweep_rate", most=STEEPEST * least**2, why=why)
    span = (most**2 - least**2) / 2
    check_si("rate", rate, "sweep_rate", most=span, why="a sweep lasts a forcing period at least")
    why = f"a sweep lasts {MOST_PERIODS} forcing periods at most"
    return least, most, check_si("rate", rate, "sweep_rate", least=span / MOST_PERIODS, why=why)


def _sweep(machine, damper, first, slope, count):
    """Sweep from a frequency on at a rate of change, Hz/s, through a number of forcing periods.

    Returns
    -------
    times, frequencies : numpy.ndarray, shape (count,)
        In the scales of the machine.
    runs : list of tuple
        Without and with the damper: envelope, contacts, status.
    held : int
        Forcing periods for which the first frequency was held.
    """
    begins, frequencies = sweep_periods(first, slope, count)
    decay = machine.viscous_damping / (2 * machine.mass)
    held = min(math.ceil(-math.log(SETTLED) * first / decay), HELD)
    runs = []
    for each in (None, damper):
        rows = forced(machine, each, np.concatenate([np.full(held, first), frequencies]))
        largest, contacts = envelope(rows, 2 * np.pi / rows[:, FREQUENCY], np.zeros(4), TOLERANCE)
        status = "escaped" if np.isnan(contacts[-1]) else "completed"
        runs.append((largest[held:], contacts[held:], flag("transient_status", status)))
    times = machine.scales.from_si(begins + 0.5 / frequencies, "time")
    return times, machine.scales.from_si(frequencies, "frequency"), runs, held


def sweep_periods(first, slope, count):
    """Return the times at which periods of a continuous sweep begin, and their mean frequencies.

    The phase in periods, first t + slope t^2/2, is a whole number at these times.

    Parameters
    ----------
    first : float
        Frequency at time 0, Hz.
    slope : float
        Hz/s.
    count : int
        Periods.

    Returns
    -------
    numpy.ndarray, numpy.ndarray, shape (count,)
        s and Hz.
    """
    phases = np.arange(count + 1)
    times = 2 * phases / (first + np.sqrt(first**2 + 2 * slope * phases))
    return times[:-1], 1 / np.diff(times)


def forced(machine, damper, frequencies):
    """Return the packed parameters of a machine at frequencies in Hz, shape (n, packed.COUNT).

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper or None
    frequencies : array, shape (n,)
    """
    scales = machine.scales
    scaled = None if damper is None else damper.scaled(scales)
    for end in (frequencies.max(), frequencies.min()):
        p = pack(machine.oscillator(end), scaled, scales.from_si(end, "frequency"))
    rows = np.tile(p, (len(frequencies), 1))
    # the force at each frequency, not the form for a range of them: a base has no part V
    forces, unbalances, _ = np.array([machine.forcing(each) for each in frequencies]).T
    rows[:, FREQUENCY] = scales.from_si(frequencies, "frequency")
    rows[:, FORCE] = scales.from_si(forces, "force")
    rows[:, UNBALANCE] = scales.from_si(unbalances, "unbalance")
    return rows
