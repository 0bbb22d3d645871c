"""Design of an elastic impact damper by single-term harmonic balance (section 3).

Single-term: the displacements Z1 of the primary mass and Z2, relative to the loose mass, are
approximated by one harmonic of the forcing, with the amplitudes a and b.
"""

from typing import NamedTuple

import numpy as np
import xarray as xr

from impact_damper.data.datasets import dataset, flag
from impact_damper.system.bounds import MASS_RATIO_RANGE, check_number
from impact_damper.system.checks import check_frequencies
from impact_damper.system.parameters import check_oscillator, describe
from impact_damper.theory import single_harmonic as balance
from impact_damper.theory.design_rule import peak_frequency, rule_clearance
from impact_damper.theory.free_oscillator import free_solutions, resonance
from impact_damper.theory.slow_flow import fixed_points, growth_rate, stability

# Largest numbers, per frequency, for which the dataset has room: of solutions, free motions and
# roots of (14). No more than six solutions with impacts have been found at a frequency.
MOST_SOLUTIONS, MOST_FREE, MOST_ROOTS = 12, 3, 6
SEARCH_STEP = 0.005
SEARCHED = (0.2, 2.0)
EDGE_TOLERANCE = 1e-10
EDGES = ["lower", "upper"]


def optimum_clearance(oscillator, mass_ratio) -> float:
    """Clearance d0 = f/(rm Wp^2) of rule (19), for which a = 0 solves (13) at the peak.

    Parameters
    ----------
    oscillator : Oscillator
    mass_ratio : float
        rm, dimensionless.

    Returns
    -------
    float
        Clearance on each side, half the free space.

    Raises
    ------
    TypeError, ValueError
        If the mass ratio is not a number or out of range, or there is no peak or no forcing.
    """
    check_oscillator(oscillator)
    mass_ratio = check_number("mass_ratio", mass_ratio, **MASS_RATIO_RANGE)
    return rule_clearance(oscillator, mass_ratio)


def harmonic_balance(oscillator, damper, frequencies):
    """Return `harmonic_balance_response`; if there is a damper, with its `suppression_band`."""
    response = harmonic_balance_response(oscillator, damper, frequencies)
    if damper is None:
        return response
    band = suppression_band(oscillator, damper)
    return xr.merge([response, band], combine_attrs="override")


def harmonic_balance_response(oscillator, damper, frequencies):
    """Frequency response by harmonic balance: every solution, stable or not.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
        Elastic; without a damper only the free response is returned.
    frequencies : array_like, shape (n,)
        Increasing forcing frequencies W, dimensionless.

    Returns
    -------
    xarray.Dataset
        For each (frequency, free_solution) a motion without the damper. With a damper also, for
        each (frequency, solution), a solution of (7) or a motion in which the loose mass rests,
        whose stability is that of the free slow flow because the place of the loose mass is
        neutral; and for each (frequency, root) a root of (14). Unused entries are NaN or flagged
        absent; the number of used entries is given for each frequency.

    Raises
    ------
    ValueError
        If the damper is not elastic, or frequencies are not positive and increasing.
    """
    check_oscillator(oscillator)
    frequencies = check_frequencies(frequencies)
    tables = [_free_table(oscillator, frequencies)]
    if damper is not None:
        tables += [
            _solution_table(oscillator, damper, frequencies),
            _rigid_table(oscillator, damper, frequencies),
        ]
    data = {name: values for table in tables for name, values in table.items()}
    return dataset(
        data,
        {"frequency": frequencies},
        describe(oscillator, damper),
        "Frequency response by harmonic balance",
    )


def _padded(rows, size, fill=np.nan):
    """Rows of unequal length as one array of shape (len(rows), size)."""
    table = np.full((len(rows), size), fill)
    for target, row in zip(table, rows, strict=True):
        target[: len(row)] = row
    return table


def _free_table(oscillator, frequencies):
    free = [free_solutions(oscillator, frequency) for frequency in frequencies]
    signs = [
        stability(growth_rate(fixed_points(each), oscillator, None, frequency))
        for each, frequency in zip(free, frequencies, strict=True)
    ]
    return {
        "free_amplitude": _padded([each.amplitude for each in free], MOST_FREE),
        "free_phase": _padded([each.phase for each in free], MOST_FREE),
        "free_stability": _padded(signs, MOST_FREE, flag("free_stability", "absent")),
        "free_count": [len(each.phase) for each in free],
    }


def _solution_table(oscillator, damper, frequencies):
    rows, status = [], []
    for frequency in frequencies:
        resting = balance.resting_solutions(oscillator, damper, frequency)
        status.append(flag("balance_status", "solved"))
        try:
            impacting = balance.impacting_solutions(oscillator, damper, frequency)
        except ArithmeticError:
            impacting = balance.Solutions(*np.empty((3, 0)))
            status[-1] = flag("balance_status", "unresolved")
        growth = np.concatenate(
            [
                growth_rate(fixed_points(impacting), oscillator, damper, frequency),
                growth_rate(fixed_points(resting)[:, :2], oscillator, None, frequency),
            ]
        )
        kinds = np.repeat(
            [flag("kind", "impacting"), flag("kind", "resting")],
            [len(impacting.phase), len(resting.phase)],
        )
        rows.append([*map(np.concatenate, zip(impacting, resting, strict=True)), growth, kinds])
    amplitude, relative, phase, growth, kinds = zip(*rows, strict=True)
    return {
        "amplitude": _padded(amplitude, MOST_SOLUTIONS),
        "relative_amplitude": _padded(relative, MOST_SOLUTIONS),
        "phase": _padded(phase, MOST_SOLUTIONS),
        "growth_rate": _padded(growth, MOST_SOLUTIONS),
        "stability": _padded(
            [stability(row) for row in growth], MOST_SOLUTIONS, flag("stability", "absent")
        ),
        "kind": _padded(kinds, MOST_SOLUTIONS, flag("kind", "absent")),
        "solution_count": [len(row) for row in amplitude],
        "balance_status": status,
    }


def _rigid_table(oscillator, damper, frequencies):
    rigid = [balance.rigid_solutions(oscillator, damper, frequency) for frequency in frequencies]
    walls = [
        np.where(each.pulling, flag("rigid_wall", "pulls"), flag("rigid_wall", "pushes"))
        for each in rigid
    ]
    return {
        "rigid_tangent": _padded([each.tangent for each in rigid], MOST_ROOTS),
        "rigid_amplitude": _padded([each.amplitude for each in rigid], MOST_ROOTS),
        "rigid_phase": _padded([each.phase for each in rigid], MOST_ROOTS),
        "rigid_residual": _padded([each.residual for each in rigid], MOST_ROOTS),
        "rigid_wall": _padded(walls, MOST_ROOTS, flag("rigid_wall", "absent")),
        "rigid_count": [len(each.phase) for each in rigid],
    }


def suppression_band(oscillator, damper):
    """Frequency range around the peak in which one quiet motion replaces the resonance branch.

    A frequency belongs to the band if (7) has exactly one stable solution there, and its
    |a| is below the amplitude of the free resonance branch. The band is the connected
    range of such frequencies that holds the peak frequency Wp. The free resonance branch
    is that of `free_oscillator.resonance`: with a hardening spring it ends at the upper fold,
    and so does the band, at the latest; where the free response has no fold it is the whole
    curve. Motions in which the loose mass rests do not count, as in the paper.

    The search goes from Wp in steps of 0.005 Wp down to 0.2 Wp and up to 2 Wp, and the
    edges are bisected to 1e-10; a gap narrower than a step can be passed over.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
        Elastic.

    Returns
    -------
    xarray.Dataset
        For each `edge` (lower, upper) its frequency and what ends the band there; the width of the
        band; the reduction of |a| at Wp and at the edges; and `break_even_frequency`, above Wp
        (below with a softening spring), where the quiet motion is no longer smaller than the
        smallest free one: the end of the band if the end of the resonance branch is disregarded.
        NaN and a flag where an edge is not found; all NaN, and the status no_peak, if the free
        response has no peak.

    Raises
    ------
    ValueError
        If the damper is not elastic.
    ArithmeticError
        If (7) could not be resolved at a frequency.
    """
    check_oscillator(oscillator)
    balance.check_elastic(damper)
    title = "Suppression band by harmonic balance"
    try:
        peak = peak_frequency(oscillator)
        resonance(oscillator, peak)
    except ValueError:
        return dataset(_no_band(), {"edge": EDGES}, describe(oscillator, damper), title)
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
        describe(oscillator, damper),
        title,
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
    """Number of solutions of (7) at a frequency, |a| of the stable ones, and free amplitudes.

    `resonance` is the amplitude of the free resonance branch, `least_free` the smallest free one.
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
    solutions = balance.impacting_solutions(oscillator, damper, frequency)
    growth = growth_rate(fixed_points(solutions), oscillator, damper, frequency)
    free, branch = free_solutions(oscillator, frequency), resonance(oscillator, frequency)
    stable = np.sort(np.abs(solutions.amplitude[stability(growth) == flag("stability", "stable")]))
    amplitude = np.nan if branch.phase is None else branch.amplitude
    return _Look(len(growth), stable, amplitude, free.amplitude[0])


def _edge(inside, peak, limit):
    """Return neighbouring frequencies inside and outside the band, or None.

    The search goes from the peak to limit * peak. `inside` returns whether a frequency belongs
    to the band; both frequencies differ by EDGE_TOLERANCE at most.
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
    """Return the event that ends the band, by comparing the motions on both sides of its edge."""
    if np.isnan(outer.resonance):
        return "resonance_branch_ends"
    same = inner.count == outer.count
    if len(outer.stable) > 1:
        return "other_motion_stabilises" if same else "other_motion_appears"
    if len(outer.stable) == 0:
        return "quiet_motion_destabilises" if same else "quiet_motion_folds"
    return "no_reduction"
