"""The ring-down (unforced decay) of a machine from a displacement, with its damper and without.

Z1 is the displacement of the primary mass.
"""

import math

import numpy as np
from scipy.special import ellipk

from impact_damper.data.datasets import dataset, flag, in_si
from impact_damper.design.swept_sine import EQUIPMENT, TOLERANCE
from impact_damper.kernel.equation import energy
from impact_damper.model.bounds import FARTHEST
from impact_damper.model.families import FORCING
from impact_damper.model.machine import check_fit
from impact_damper.model.packed import cubic_spring, pack
from impact_damper.model.units import check_si
from impact_damper.motions.records import envelope

# A ring-down ends when the energy has fallen to the energy at REST times the first displacement, or
# after MOST_WINDOWS windows. A window is a period of the unforced vibration.
REST = 1e-3
MOST_WINDOWS = 10**4
# With a softening spring the period tends to infinity at the barrier over which the machine
# escapes. A window is therefore at most LONGEST periods of small vibrations.
LONGEST = 2.0


def ring_down(machine, damper, displacement):
    """Compute the unforced decay of a machine from a displacement, with its damper and without.

    Machine and loose mass are at rest at the beginning, with the loose mass in the middle of the
    gap.

    Parameters
    ----------
    machine : Machine
    damper : MachineDamper
        It must have a contact stiffness.
    displacement : float
        First displacement in m, above 0.

    Returns
    -------
    xarray.Dataset
        In SI units. Time is divided into windows. The length of a window is the period of an
        undamped unforced vibration with the energy that the motion has at the beginning of the
        window.

        - (equipment, window): `time` at the middle of the window, `frequency` (the inverse of the
          window's length), `envelope` (largest displacement in the window) and `window_contacts`
          (number of contacts), NaN after the end of the ring-down.
        - (equipment): `transient_status`: at_rest if the energy of both masses has fallen to the
          energy of the machine at REST times the displacement; escaped if the motion has crossed
          the barrier of a softening spring; limit after MOST_WINDOWS windows.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    check_fit(machine, damper)
    scales = machine.scales
    most = scales.to_si(FARTHEST, "displacement")
    displacement = check_si("displacement", displacement, "displacement", above=0, most=most)
    first = scales.from_si(displacement, "displacement")
    runs = [_decay(_unforced(machine, each), first) for each in (None, damper)]
    padded = np.full((len(EQUIPMENT), max(len(run) for run, _ in runs), 4), np.nan)
    for rows, (run, _) in zip(padded, runs, strict=True):
        rows[: len(run)] = run
    names = ("time", "frequency", "envelope", "window_contacts")
    data = {name: (("equipment", "window"), padded[..., k]) for k, name in enumerate(names)}
    data["transient_status"] = [flag("transient_status", status) for _, status in runs]
    parameters = {"displacement": first, "tolerance": TOLERANCE}
    labelled = dataset(data, {"equipment": list(EQUIPMENT)}, parameters, "Ring-down")
    return in_si(labelled, machine, damper)


def _unforced(machine, damper):
    """Return the packed parameters of a machine without forcing, with its damper or None.

    The forcing frequency in these parameters has no effect.
    """
    scales = machine.scales
    scaled = None if damper is None else damper.scaled(scales)
    p = pack(machine.oscillator(scales.to_si(1.0, "frequency")), scaled, 1.0)
    p[list(FORCING.values())] = 0.0
    return p


def _decay(p, displacement):
    """Compute the unforced decay of an oscillator from a displacement, in dimensionless numbers.

    Returns
    -------
    rows : numpy.ndarray, shape (windows, 4)
        Time at the middle of each window, frequency, largest |Z1|, number of contacts.
    status : str
        "at_rest", "escaped" or "limit".
    """
    y = np.array([displacement, 0.0, 0.0, 0.0])
    rest = energy.py_func(p, REST * y)
    rows, begin = [], 0.0
    while len(rows) < MOST_WINDOWS:
        left = energy.py_func(p, y)
        if left <= rest:
            return np.array(rows), "at_rest"
        length = _window(p, left)
        (largest,), (contacts,) = envelope(p[None], np.array([length]), y, TOLERANCE)
        rows.append((begin + length / 2, 2 * np.pi / length, largest, contacts))
        if largest == np.inf:
            return np.array(rows), "escaped"
        begin += length
    return np.array(rows), "limit"


def _window(p, left):
    """Return the length of a window: the undamped period at the energy `left`, up to LONGEST."""
    stiffness, cubic = cubic_spring(p)
    period = unforced_period(stiffness, cubic, unforced_amplitude(stiffness, cubic, left))
    if cubic >= 0:
        return period
    return min(period, LONGEST * 2 * np.pi / np.sqrt(stiffness))


def unforced_amplitude(stiffness, cubic, stored) -> float:
    """Return the amplitude A of x'' + a x + b x^3 = 0 with the energy a A^2/2 + b A^4/4.

    Parameters
    ----------
    stiffness, cubic : float
        a >= 0 and b, dimensionless, one of them above 0.
    stored : float
        Energy.

    Returns
    -------
    float
        The amplitude, infinite if a softening spring cannot store the energy.
    """
    square = stiffness**2 + 4 * cubic * stored
    if square <= 0:
        return math.inf if stored > 0 else 0.0
    return 2 * math.sqrt(stored / (stiffness + math.sqrt(square)))


def unforced_period(stiffness, cubic, amplitude) -> float:
    """Return the period of x'' + a x + b x^3 = 0 at an amplitude A.

    The motion is A cn(w t | m) with w^2 = a + b A^2 and m = b A^2/(2 w^2). Its period is 4 K(m)/w,
    with the complete elliptic integral K. (A. H. Nayfeh and D. T. Mook, Nonlinear Oscillations,
    1979, section 2.1.)

    Parameters
    ----------
    stiffness, cubic : float
        a and b, dimensionless.
    amplitude : float
        A, above 0 if a is 0.

    Returns
    -------
    float
        The period, infinite if A reaches the barrier A^2 = -a/b of a softening spring.
    """
    square = stiffness + cubic * amplitude**2
    if square <= 0:
        return math.inf
    return 4 * float(ellipk(cubic * amplitude**2 / (2 * square))) / math.sqrt(square)
