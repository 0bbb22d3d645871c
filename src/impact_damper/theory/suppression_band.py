"""The suppression band of an elastic impact damper, by single-term harmonic balance (section 3).

Single-term means that one harmonic of the forcing approximates the motion. The suppression band is
the range of the forcing frequency W in which a small motion replaces the large one that exists
without the damper. Free means without the damper. The free resonance branch consists of the large
free motions; with a hardening spring it ends at a fold above its peak, the frequency Wp.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.data.datasets import dataset, flag
from impact_damper.model.arguments import read_system
from impact_damper.theory.design_rule import peak_frequency
from impact_damper.theory.free_oscillator import free_solutions, resonance
from impact_damper.theory.single_harmonic import check_elastic, impacting_solutions
from impact_damper.theory.slow_flow import fixed_points, growth_rate, stability

# Search for an edge of the band.
# SEARCHED: least and greatest W/Wp.
# SEARCH_STEP: step in W/Wp.
# EDGE_TOLERANCE: largest error of the frequency of an edge.
SEARCHED = (0.2, 2.0)
SEARCH_STEP = 0.005
EDGE_TOLERANCE = 1e-10
EDGES = ["lower", "upper"]


def suppression_band(system, damper):
    """Find the frequencies around the peak at which one quiet motion replaces the resonance branch.

    The band is computed by harmonic balance, equation (7) of the paper, whose solutions have the
    amplitude |a|. A frequency belongs to the band if (7) has exactly one stable solution, and |a|
    of this solution is below the amplitude of the free resonance branch. The band is the connected
    range of such frequencies that contains the peak frequency Wp. With a hardening spring the free
    resonance branch (`free_oscillator.resonance`), and with it the band, ends at the upper fold. If
    the free response has no fold, the branch is the whole curve. Motions in which the loose mass
    rests do not count, as in the paper.

    The search goes from Wp in steps of 0.005 Wp down to 0.2 Wp and up to 2 Wp, and the edges are
    bisected to 1e-10. An interruption of the band narrower than a step can be missed.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper or MachineDamper
        Elastic.

    Returns
    -------
    xarray.Dataset
        For each `edge` (lower, upper) its frequency and the event that ends the band there; the
        width of the band; the reduction of |a| at Wp and at the edges; and `break_even_frequency`.
        Beyond this frequency, which lies above Wp (below with a softening spring), the quiet motion
        is not smaller than the smallest free motion. NaN and a flag where an edge is not found. All
        NaN, and the status no_peak, if the free response has no peak.

    Raises
    ------
    ValueError
        If the damper is not elastic.
    ArithmeticError
        If (7) could not be resolved at a frequency.

    Examples
    --------
    >>> import impact_damper as idm
    >>> band = suppression_band(idm.Oscillator(0.215), idm.Damper(0.12, 2.0))
    >>> band.edge_frequency.values.round(3)
    array([1.911, 2.008])
    """
    model = read_system(system, damper, needs_damper=True)
    oscillator, damper = model.oscillator, model.damper
    check_elastic(damper)
    title = "Suppression band by harmonic balance"
    try:
        peak = peak_frequency(oscillator)
        resonance(oscillator, peak)
    except ValueError:
        return dataset(_no_band(), {"edge": EDGES}, model.describe(), title, model)
    highest = oscillator.forcing_amplitude(peak) / (oscillator.damping * peak)

    def look(frequency):
        return _look(oscillator, damper, frequency)

    middle = look(peak)
    status, frequency, event, reduction = middle.status(), [np.nan] * 2, [0, 0], [np.nan] * 2
    break_even = None
    if status == "found":
        for k, limit in enumerate(SEARCHED):
            edge = _edge(lambda w: look(w).status() == "found", peak, limit)
            if edge is not None:
                inner, outer = look(edge[0]), look(edge[1])
                frequency[k], event[k] = edge[0], flag("edge_event", _event(inner, outer))
                reduction[k] = 1 - inner.stable[0] / inner.resonance
        if middle.beats_free():
            limit = SEARCHED[0 if oscillator.hardening < 0 else 1]
            break_even = _edge(lambda w: look(w).beats_free(), peak, limit)
    quiet = middle.stable[0] if len(middle.stable) else np.nan
    return dataset(
        {
            "band_status": flag("band_status", status),
            "edge_frequency": frequency,
            "edge_event": event,
            "edge_reduction": reduction,
            "band_width": frequency[1] - frequency[0],
            "peak_frequency": peak,
            "peak_amplitude": highest,
            "quiet_amplitude": quiet,
            "reduction": 1 - quiet / highest,
            "break_even_frequency": np.nan if break_even is None else break_even[0],
        },
        {"edge": EDGES},
        model.describe(),
        title,
        model,
    )


def _no_band():
    """Return the variables of `suppression_band` if the free response has no peak."""
    return {
        "band_status": flag("band_status", "no_peak"),
        "edge_frequency": [np.nan] * 2,
        "edge_event": [flag("edge_event", "not_found")] * 2,
        "edge_reduction": [np.nan] * 2,
    } | dict.fromkeys(
        (
            "band_width",
            "peak_frequency",
            "peak_amplitude",
            "quiet_amplitude",
            "reduction",
            "break_even_frequency",
        ),
        np.nan,
    )


class _Look(NamedTuple):
    """The solutions of (7) and the free motions at one frequency.

    count: Number of solutions of (7).
    stable: |a| of the stable solutions, ascending.
    resonance: Amplitude of the free resonance branch; NaN beyond its end.
    least_free: Smallest amplitude of a free motion.
    """

    count: int
    stable: np.ndarray
    resonance: float
    least_free: float

    def status(self):
        if len(self.stable) != 1:
            return "no_single_motion"
        return "found" if self.stable[0] < self.resonance else "no_reduction"

    def beats_free(self):
        return len(self.stable) > 0 and self.stable[0] < self.least_free


def _look(oscillator, damper, frequency):
    solutions = impacting_solutions(oscillator, damper, frequency)
    growth = growth_rate(fixed_points(solutions), oscillator, damper, frequency)
    free, branch = free_solutions(oscillator, frequency), resonance(oscillator, frequency)
    stable = np.sort(np.abs(solutions.amplitude[stability(growth) == flag("stability", "stable")]))
    amplitude = np.nan if branch.phase is None else branch.amplitude
    return _Look(len(growth), stable, amplitude, free.amplitude[0])


def _edge(inside, peak, limit):
    """Return two frequencies on both sides of an edge of the band, the inner one first, or None.

    They differ by EDGE_TOLERANCE at most. The search goes from `peak` to `limit` times `peak`.
    `inside` is a function that returns whether a frequency belongs to the band.
    """
    step = np.sign(limit - 1) * SEARCH_STEP * peak
    inner = peak
    for outer in np.arange(peak + step, limit * peak, step):
        if not inside(outer):
            break
        inner = outer
    else:
        return None
    while abs(outer - inner) > EDGE_TOLERANCE:
        middle = (inner + outer) / 2
        inner, outer = (middle, outer) if inside(middle) else (inner, middle)
    return inner, outer


def _event(inner, outer):
    """Return the flag `edge_event`, from the solutions on both sides of an edge of the band."""
    if np.isnan(outer.resonance):
        return "resonance_branch_ends"
    same = inner.count == outer.count
    if len(outer.stable) > 1:
        return "other_motion_stabilises" if same else "other_motion_appears"
    if len(outer.stable) == 0:
        return "quiet_motion_destabilises" if same else "quiet_motion_folds"
    return "no_reduction"
