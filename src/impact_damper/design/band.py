"""Forcing frequencies of a design: the band, the resonances in it, and the grid of frequencies."""

import math
from collections.abc import Sequence

import numpy as np

from impact_damper.model.bounds import shown
from impact_damper.model.text import with_unit
from impact_damper.theory.free_oscillator import free_folds, maximum_response


def resonance_of(machine) -> tuple[float, float]:
    """Return the lowest and the highest frequency at which the machine without damper resonates.

    The frequencies are in Hz. The range contains the natural frequency of small vibrations, if the
    spring has a linear part, and the peak of the response by harmonic balance. A cubic spring moves
    the peak away from the natural frequency. The response over the frequency then bends, and the
    range also contains its folds, the points at which it turns back.
    """
    natural = machine.natural_frequency
    oscillator = machine.oscillator()
    found = [point.frequency for point in free_folds(oscillator)]
    try:
        found.append(maximum_response(oscillator).frequency)
    except ValueError:
        pass  # no peak: heavy damping, or motion over the barrier of a softening spring
    ends = [*machine.scales.to_si(np.array(found), "frequency")]
    if natural or not ends:
        ends.append(natural)
    return float(min(ends)), float(max(ends))


def checked_band(machine, band, resonance) -> tuple[float, float]:
    """Check a band of frequencies, and return its ends, Hz.

    Parameters
    ----------
    machine : Machine
    band : sequence of 2 numbers, texts or pint.Quantity
    resonance : tuple of float
        Result of `resonance_of`.

    Raises
    ------
    TypeError, ValueError
        If the band is not two ascending frequencies, or does not overlap the range `resonance`.
    """
    if not isinstance(band, Sequence | np.ndarray) or len(band) != 2:
        raise ValueError(f"band = {shown(band)}: must be least and greatest frequency")
    ends = tuple(machine.check_frequency(f"band[{i}]", value) for i, value in enumerate(band))
    low, high = resonance
    if not ends[0] < ends[1] or ends[1] < low or ends[0] > high:
        given = " to ".join(with_unit(end, "Hz") for end in ends)
        where = f"{low:.4g} Hz" if high - low < 1e-3 * low else f"{low:.4g} to {high:.4g} Hz"
        raise ValueError(
            f"band = {given}: must ascend and reach into the resonance of the machine, at "
            f"{where} (away from its resonance a machine needs no damper)"
        )
    return ends


def resonances_within(band, resonance, mass_ratio) -> list[float]:
    """Return the resonances within a band, Hz: without the loose mass, and with it fixed on.

    `resonance` is the result of `resonance_of`. The fixed loose mass lowers the frequencies.
    """
    ratio = math.sqrt(1 + mass_ratio)
    found = [each for end in resonance for each in (end / ratio, end)]
    return [each for each in found if band[0] < each < band[1]]


def grid_over(band, count, resonances) -> np.ndarray:
    """Return `count` frequencies over a band, Hz.

    The frequencies are evenly spaced, with one exception: the frequency nearest to each resonance
    is moved onto it, since a lightly damped machine moves most there. The ends of the band stay.
    """
    values = np.linspace(*band, count)
    for frequency in resonances:
        values[1 + np.argmin(np.abs(values[1:-1] - frequency))] = frequency
    return np.unique(values)
