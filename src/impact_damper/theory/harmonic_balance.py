"""Single-term harmonic balance of an elastic impact damper over frequency and over clearance.

Equation (7) of the paper is the balance with elastic contacts, (14) the limit for rigid walls.
"""

from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from impact_damper.data.datasets import dataset, flag
from impact_damper.model.arguments import read_frequencies, read_system
from impact_damper.model.bounds import names_arguments
from impact_damper.model.parameters import beyond_closed_forms
from impact_damper.theory.design_rule import peak_frequency
from impact_damper.theory.free_oscillator import free_solutions, resonance
from impact_damper.theory.single_harmonic import (
    Solutions,
    fixed_points,
    growth_rate,
    impacting_solutions,
    resting_solutions,
    rigid_solutions,
    stability,
)

# Largest change of a solution along a branch, from one value of the parameter to the next, divided
# by the largest component of all solutions at all values.
JUMP = 0.25


def branches_over(rows) -> list[np.ndarray]:
    """Return for each row of solutions an array with the index of each solution's branch.

    A row holds the solutions at one value of a parameter. Two solutions of consecutive rows are on
    one branch if each is the nearest to the other, and their distance is small (see JUMP).
    """
    sizes = [np.max(np.abs(row)) for row in rows if len(row)]
    reach = JUMP * max(sizes, default=1.0)
    numbers, begun = [], 0
    last, names = np.empty((0, 1)), np.empty(0, int)
    for row in rows:
        branch = np.full(len(row), -1)
        if len(row) and len(last):
            distance = np.linalg.norm(row[:, None] - last[None], axis=2)
            before, after = distance.argmin(axis=1), distance.argmin(axis=0)
            place = np.arange(len(row))
            kept = (after[before] == place) & (distance[place, before] < reach)
            branch[kept] = names[before[kept]]
        new = branch < 0
        branch[new] = begun + np.arange(new.sum())
        begun += int(new.sum())
        numbers.append(branch)
        last, names = row, branch
    return numbers


@names_arguments
def harmonic_balance(system, damper, frequencies):
    """Return all solutions of single-term harmonic balance, and with a damper the suppression band.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
        An elastic damper, or None for the free response only.
    frequencies : array_like, shape (n,)
        Increasing forcing frequencies W, or Hz for a machine.

    Returns
    -------
    xarray.Dataset
        Variables over (frequency, free_solution) describe motions without the damper. With a
        damper, variables over (frequency, solution) describe solutions of (7) and motions in which
        the loose mass rests. Variables over (frequency, root) describe roots of (14). Each index
        along `free_solution`, `solution` or `root` stands for a branch from one fold to the next.
        Where a branch does not exist, entries are NaN or flagged absent.

        By harmonic balance the suppression band is the range of frequencies around the peak Wp of
        the free response in which (7) has exactly one stable solution, smaller than the free
        resonance. Beyond the fold of the free resonance branch there is no band. The variables of
        the band are its edges (NaN if not found), its width and Wp. Two further variables are
        the free resonance amplitude at Wp, and the smallest stable amplitude with the damper at Wp.

    Raises
    ------
    ValueError
        If the damper is not elastic, or frequencies are not positive and increasing.
    ArithmeticError
        If the solutions of (7) cannot be found at a frequency in the search for the band.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> found = idm.harmonic_balance(oscillator, damper, [1.5, 2.0])
    >>> found.edge_frequency.values.round(3)
    array([1.911, 2.008])
    """
    model = read_system(system, damper)
    oscillator, damper = model.oscillator, model.damper
    frequencies = read_frequencies(model.scales, frequencies)
    data, coordinates = _free_table(oscillator, frequencies), {"frequency": frequencies}
    if damper is not None:
        data |= _solution_table(oscillator, damper, frequencies)
        data |= _rigid_table(oscillator, damper, frequencies) | _band(oscillator, damper)
        coordinates["edge"] = EDGES
    title = "Frequency response by harmonic balance"
    return dataset(data, coordinates, model.describe(), title, model)


def _table(columns, rows, fill=np.nan):
    width = max((1 + row.max() for row in columns if len(row)), default=1)
    table = np.full((len(rows), width), fill)
    for target, place, row in zip(table, columns, rows, strict=True):
        target[place] = row
    return table


def _free_table(oscillator, frequencies):
    free = [free_solutions(oscillator, frequency) for frequency in frequencies]
    points = [fixed_points(each) for each in free]
    signs = [
        stability(growth_rate(each, oscillator, None, frequency))
        for each, frequency in zip(points, frequencies, strict=True)
    ]
    columns = branches_over(points)
    return {
        "free_amplitude": _table(columns, [each.amplitude for each in free]),
        "free_phase": _table(columns, [each.phase for each in free]),
        "free_stability": _table(columns, signs, flag("free_stability", "absent")),
    }


def _solution_table(oscillator, damper, frequencies):
    impacting, status = [], []
    for frequency in frequencies:
        try:
            impacting.append(impacting_solutions(oscillator, damper, frequency))
            status.append(flag("balance_status", "solved"))
        except ArithmeticError:
            impacting.append(Solutions(*np.empty((3, 0))))
            status.append(flag("balance_status", "unresolved"))
    resting = [resting_solutions(oscillator, damper, w) for w in frequencies]
    moving, still = ([fixed_points(each) for each in part] for part in (impacting, resting))
    growth = [
        np.append(
            growth_rate(first, oscillator, damper, frequency),
            growth_rate(second[:, :2], oscillator, None, frequency),
        )
        for first, second, frequency in zip(moving, still, frequencies, strict=True)
    ]
    names = flag("kind", "impacting"), flag("kind", "resting")
    kinds = [np.repeat(names, [len(a), len(b)]) for a, b in zip(moving, still, strict=True)]
    columns, others = branches_over(moving), branches_over(still)
    begun = max((1 + row.max() for row in columns if len(row)), default=0)
    columns = [np.append(a, begun + b) for a, b in zip(columns, others, strict=True)]
    both = [Solutions(*map(np.append, a, b)) for a, b in zip(impacting, resting, strict=True)]
    return {
        "amplitude": _table(columns, [each.amplitude for each in both]),
        "relative_amplitude": _table(columns, [each.relative_amplitude for each in both]),
        "phase": _table(columns, [each.phase for each in both]),
        "growth_rate": _table(columns, growth),
        "stability": _table(
            columns, [stability(row) for row in growth], flag("stability", "absent")
        ),
        "kind": _table(columns, kinds, flag("kind", "absent")),
        "balance_status": status,
    }


def _rigid_table(oscillator, damper, frequencies):
    rigid = [rigid_solutions(oscillator, damper, each) for each in frequencies]
    pulls, pushes = (flag("rigid_wall", name) for name in ("pulls", "pushes"))
    walls = [np.where(each.amplitude > damper.clearance, pulls, pushes) for each in rigid]
    columns = branches_over([fixed_points(each) for each in rigid])
    return {
        "rigid_amplitude": _table(columns, [each.amplitude for each in rigid]),
        "rigid_wall": _table(columns, walls, flag("rigid_wall", "absent")),
    }


SEARCHED = (0.2, 2.0)  # lowest and highest W/Wp
SEARCH_STEP = 0.005  # step of W/Wp
EDGE_TOLERANCE = 1e-10  # largest error of W at an edge
EDGES = ["lower", "upper"]
SIZES = ("band_width", "peak_frequency", "peak_amplitude", "quiet_amplitude", "reduction")


def _band(oscillator, damper):
    data = dict.fromkeys(SIZES, np.nan) | {
        "band_status": flag("band_status", "no_peak"),
        "edge_frequency": [np.nan] * 2,
    }
    try:
        peak = peak_frequency(oscillator)
        resonance(oscillator, peak)
    except ValueError:
        return data
    highest = oscillator.forcing_amplitude(peak) / (oscillator.damping * peak)

    def inside(frequency):
        return _look(oscillator, damper, frequency)[0] == "found"

    found, stable = _look(oscillator, damper, peak)
    if found == "found":
        edges = [_edge(inside, peak, limit) for limit in SEARCHED]
        data["edge_frequency"] = edges
        data["band_width"] = edges[1] - edges[0]
    quiet = stable[0] if len(stable) else np.nan
    return data | {
        "band_status": flag("band_status", found),
        "peak_frequency": peak,
        "peak_amplitude": highest,
        "quiet_amplitude": quiet,
        "reduction": 1 - quiet / highest,
    }


def _look(oscillator, damper, frequency):
    stable = np.sort(np.abs(_stable_amplitudes(oscillator, damper, frequency)))
    free = resonance(oscillator, frequency)
    if len(stable) != 1:
        return "no_single_motion", stable
    reduced = free.phase is not None and stable[0] < free.amplitude
    return "found" if reduced else "no_reduction", stable


def _edge(inside, peak, limit):
    step = np.sign(limit - 1) * SEARCH_STEP * peak
    inner = peak
    for outer in np.arange(peak + step, limit * peak, step):
        if not inside(outer):
            break
        inner = outer
    else:
        return np.nan
    while abs(outer - inner) > EDGE_TOLERANCE:
        middle = (inner + outer) / 2
        inner, outer = (middle, outer) if inside(middle) else (inner, middle)
    return inner


def _stable_amplitudes(oscillator, damper, frequency):
    solutions = impacting_solutions(oscillator, damper, frequency)
    growth = growth_rate(fixed_points(solutions), oscillator, damper, frequency)
    return solutions.amplitude[stability(growth) == flag("stability", "stable")]


# An amplitude counts as 0 if |a| is below ZERO_AMPLITUDE times the clearance.
ZERO_AMPLITUDE = 1e-6


def _smallest(oscillator, damper, frequency):
    if damper.restitution != 1:
        return np.nan, "inelastic"
    if beyond_closed_forms(oscillator, damper):
        return np.nan, "unknown"
    try:
        stable = _stable_amplitudes(oscillator, damper, frequency)
    except ArithmeticError:
        return np.nan, "unresolved"
    return (min(stable, key=abs), "found") if len(stable) else (np.nan, "absent")


def analytical_table(oscillator, dampers, frequency):
    """Return dataset variables for `dampers`, which differ only in their clearances (ascending).

    For each damper: the smallest |a| of stable solutions of (7), where a is the amplitude of Z1.
    For all dampers together: one clearance at which a is 0, or NaN if no such clearance is found.
    """
    found = [_smallest(oscillator, each, frequency) for each in dampers]
    signed, status = np.array([size for size, _ in found]), [name for _, name in found]
    best = np.nan

    def amplitude(clearance):
        return _smallest(oscillator, replace(dampers[0], clearance=clearance), frequency)[0]

    for k in np.flatnonzero(signed[1:] * signed[:-1] < 0):
        clearance = brentq(amplitude, dampers[k].clearance, dampers[k + 1].clearance)
        # A change of sign at a jump from one solution to another is not a zero of the amplitude.
        if abs(amplitude(clearance)) < ZERO_AMPLITUDE * clearance:
            best = clearance
    return {
        "analytical_amplitude": np.abs(signed),
        "analytical_status": np.array([flag("analytical_status", each) for each in status]),
        "analytical_optimum": best,
    }
