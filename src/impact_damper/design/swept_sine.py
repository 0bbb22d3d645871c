"""A swept sine, up and down, on a machine with its damper and without.

The forcing frequency changes at a constant rate. The integrator requires a fixed frequency. In the
simulation each forcing cycle therefore has a fixed frequency: the mean frequency of this cycle in
the continuous sweep. The cycles begin and end at the same times as those of the continuous sweep.
Within a cycle the phases of the two differ by at most pi/4 times the relative change of the
frequency in this cycle.
"""

import json
import math

import numpy as np

from impact_damper.data.datasets import dataset, flag, in_si
from impact_damper.model.bounds import shown
from impact_damper.model.machine import check_fit
from impact_damper.model.packed import FORCE, FREQUENCY, UNBALANCE, pack
from impact_damper.model.units import check_si
from impact_damper.motions.records import envelope

DIRECTIONS = ("up", "down")
# The machine without the damper, and with it.
EQUIPMENT = ("bare", "damped")
# Largest local error of an integration step.
TOLERANCE = 1e-10
# Largest relative change of the frequency in a forcing cycle, and largest number of forcing cycles.
STEEPEST = 0.01
MOST_PERIODS = 10**6
# The first frequency is held until the transients of the machine without the damper have decayed to
# SETTLED times their first size, but at most for HELD forcing cycles.
SETTLED = 0.01
HELD = 10**5


def swept_sine(machine, damper, band, rate):
    """Sweep the forcing frequency of a machine up and down, with its damper and without.

    A motion begins at rest, with the loose mass in the middle of the gap. The first frequency is
    held until the transients of the machine without the damper have decayed. Then the sweep begins.
    In the sweep, the resonance peak of a lightly damped linear machine is lower than in steady
    state: by 1 % at the rate (damping ratio x natural frequency in Hz)^2, and by 6 % at four times
    this rate.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
        It must have a contact stiffness.
    band : sequence of 2 floats
        Least and greatest frequency, Hz.
    rate : float
        Change of the frequency per time, Hz/s, above 0. It must change the frequency by at most 1 %
        in a forcing cycle.

    Returns
    -------
    xarray.Dataset
        In SI units, with one window for each forcing cycle.

        - (direction, window): `time` from the end of the hold to the middle of the window, and
          `frequency`.
        - (direction, equipment, window): `envelope` (largest displacement in the window) and
          `window_contacts` (number of contacts). If the motion escapes over the barrier of a
          softening spring, the envelope is infinite in this window, and both are NaN in later ones.
        - (direction, equipment): `transient_status`, completed or escaped.

        The attribute `sweep` (JSON) holds band, rate and the forcing cycles for which the first
        frequency was held.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    check_fit(machine, damper)
    least, most, rate = _check_sweep(machine, band, rate)
    count = int((most**2 - least**2) / (2 * rate))
    ends = ((least, rate), (most, -rate))
    sweeps = [_sweep(machine, damper, first, slope, count) for first, slope in ends]
    times, frequencies, runs, held = zip(*sweeps, strict=True)
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
    labelled = in_si(
        dataset(data, coordinates, {"tolerance": TOLERANCE}, "Swept sine"), machine, damper
    )
    settings = {"band": [least, most], "rate": rate, "held": held}
    return labelled.assign_attrs(sweep=json.dumps(settings, sort_keys=True))


def _check_sweep(machine, band, rate):
    """Check band and rate, and return least and greatest frequency (Hz) and rate (Hz/s).

    Raises
    ------
    TypeError, ValueError
        If the band or the rate is not allowed.
    """
    if np.ndim(band) != 1 or len(band) != 2:
        raise ValueError(f"band = {shown(band)}: must be least and greatest frequency")
    least, most = (machine.check_frequency(f"band[{i}]", band[i]) for i in range(2))
    if least >= most:
        raise ValueError(f"band = {shown(band)}: must be least and greatest frequency")
    check_si("rate", rate, "sweep_rate", above=0)
    why = f"{100 * STEEPEST:g} % of band[0] in a forcing cycle"
    check_si("rate", rate, "sweep_rate", most=STEEPEST * least**2, why=why)
    span = (most**2 - least**2) / 2
    check_si("rate", rate, "sweep_rate", most=span, why="a sweep lasts a forcing cycle at least")
    why = f"a sweep lasts {MOST_PERIODS} forcing cycles at most"
    return least, most, check_si("rate", rate, "sweep_rate", least=span / MOST_PERIODS, why=why)


def _sweep(machine, damper, first, slope, count):
    """Sweep from the frequency `first` at the rate `slope` (Hz/s) over `count` forcing cycles.

    Returns
    -------
    times, frequencies : numpy.ndarray, shape (count,)
        Middles of the cycles and their frequencies, divided by the machine's scales of time and
        frequency.
    runs : list of tuple
        Envelope, contacts and status, first without the damper and then with it.
    held : int
        Forcing cycles for which the first frequency was held.
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
    """Return the times at which the cycles of a continuous sweep begin, and their mean frequencies.

    At these times the phase in cycles, first t + slope t^2/2, is a whole number.

    Parameters
    ----------
    first : float
        Frequency at time 0, Hz.
    slope : float
        Hz/s.
    count : int
        Number of cycles.

    Returns
    -------
    times, frequencies : numpy.ndarray, shape (count,)
        In s and Hz.
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
    # `machine.forcing` returns the parts of the forcing at one frequency. Its third part, the
    # shaker, is 0: it replaces the motion of the base only where the frequency varies.
    forces, unbalances, _ = np.array([machine.forcing(each) for each in frequencies]).T
    rows[:, FREQUENCY] = scales.from_si(frequencies, "frequency")
    rows[:, FORCE] = scales.from_si(forces, "force")
    rows[:, UNBALANCE] = scales.from_si(unbalances, "unbalance")
    return rows
