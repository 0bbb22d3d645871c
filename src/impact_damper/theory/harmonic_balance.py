"""Design of an elastic impact damper by single-term harmonic balance (section 3).

Single-term means that one harmonic of the forcing, with the amplitudes a and b, approximates the
displacement Z1 of the primary mass and its displacement Z2 relative to the loose mass. Numbers in
brackets are equations of the paper: (7) is the balance with elastic contacts, (14) its limit for
rigid walls. Free means without the damper. The slow flow is the equation by which amplitude and
phase of a solution change slowly; from it the stability of the solution follows.

d0 is the clearance.
"""

import numpy as np
import xarray as xr

from impact_damper.data.datasets import dataset, flag
from impact_damper.model.arguments import read_frequencies, read_system
from impact_damper.model.bounds import MASS_RATIO_RANGE
from impact_damper.model.names import names_arguments
from impact_damper.theory import single_harmonic
from impact_damper.theory.branch_order import branches_over
from impact_damper.theory.design_rule import rule_clearance
from impact_damper.theory.free_oscillator import free_solutions
from impact_damper.theory.slow_flow import fixed_points, growth_rate, stability
from impact_damper.theory.suppression_band import suppression_band


def optimum_clearance(system, mass_ratio) -> float:
    """Return the clearance of rule (19) of the paper, d0 = f/(rm Wp^2).

    f is the amplitude of the force at the frequency Wp of the peak without the damper. With this
    clearance and rigid walls harmonic balance has a solution at the peak in which the machine does
    not move. The clearance of the smallest motion is larger with elastic contact; `clearance_sweep`
    finds it.

    Parameters
    ----------
    system : Oscillator or Machine
    mass_ratio : float
        rm, dimensionless.

    Returns
    -------
    float
        Clearance on each side, half the gap; m for a machine.

    Raises
    ------
    TypeError, ValueError
        If the mass ratio is not a number or out of range, or there is no peak or no forcing.

    Examples
    --------
    >>> import impact_damper as idm
    >>> round(optimum_clearance(idm.Oscillator(0.215), 0.12), 4)
    2.0688
    """
    model = read_system(system)
    mass_ratio = model.scales.read("mass_ratio", mass_ratio, "number", **MASS_RATIO_RANGE)
    return model.scales.to_si(rule_clearance(model.oscillator, mass_ratio), "clearance")


@names_arguments
def harmonic_balance(system, damper, frequencies):
    """Return `harmonic_balance_response` and, with a damper, `suppression_band` in one dataset."""
    response = harmonic_balance_response(system, damper, frequencies)
    if damper is None:
        return response
    band = suppression_band(system, damper)
    return xr.merge([response, band], combine_attrs="override")


def harmonic_balance_response(system, damper, frequencies):
    """Return the frequency response by harmonic balance: every solution, stable or not.

    Parameters
    ----------
    system : Oscillator or Machine
    damper : Damper, MachineDamper or None
        Elastic; without a damper only the free response is returned.
    frequencies : array_like, shape (n,)
        Increasing forcing frequencies W, or Hz for a machine.

    Returns
    -------
    xarray.Dataset
        For each (frequency, free_solution) a motion without the damper. With a damper also, for
        each (frequency, solution), a solution of (7) or a motion in which the loose mass rests, and
        for each (frequency, root) a root of (14). Where the loose mass rests, it stands still in
        space and touches no wall, so the stability of the motion is the one without the damper, by
        the slow flow. Each index of `free_solution`, `solution` or `root` is a branch, continuous
        over frequency from fold to fold, so that `amplitude.plot.line(x="frequency")` draws the
        curves. Where a branch does not exist, entries are NaN or flagged absent. The number of
        solutions is given for each frequency.

    Raises
    ------
    ValueError
        If the damper is not elastic, or frequencies are not positive and increasing.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> found = idm.harmonic_balance(oscillator, damper, [1.5, 2.0])
    >>> found.frequency.values
    array([1.5, 2. ])
    """
    model = read_system(system, damper)
    oscillator, damper = model.oscillator, model.damper
    frequencies = read_frequencies(model.scales, frequencies)
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
        model.describe(),
        "Frequency response by harmonic balance",
        model,
    )


def _table(columns, rows, fill=np.nan):
    """Return rows of unequal length as one array, each entry in the column of its branch.

    `columns` holds for each row the numbers of the branches. Empty entries are `fill`.
    """
    width = max((1 + row.max() for row in columns if len(row)), default=1)
    table = np.full((len(rows), width), fill)
    for target, place, row in zip(table, columns, rows, strict=True):
        target[place] = row
    return table


def _plane(amplitude, phase):
    """Return the coefficients of cos(W T) and -sin(W T) in amplitude * cos(W T + phase)."""
    return np.stack([amplitude * np.cos(phase), amplitude * np.sin(phase)], axis=-1)


def _free_table(oscillator, frequencies):
    """Return the variables of the solutions without a damper."""
    free = [free_solutions(oscillator, frequency) for frequency in frequencies]
    signs = [
        stability(growth_rate(fixed_points(each), oscillator, None, frequency))
        for each, frequency in zip(free, frequencies, strict=True)
    ]
    columns = branches_over([_plane(each.amplitude, each.phase) for each in free])
    return {
        "free_amplitude": _table(columns, [each.amplitude for each in free]),
        "free_phase": _table(columns, [each.phase for each in free]),
        "free_stability": _table(columns, signs, flag("free_stability", "absent")),
        "free_count": [len(each.phase) for each in free],
    }


def _solution_table(oscillator, damper, frequencies):
    """Return the variables of the solutions of (7), and of motions with the loose mass at rest."""
    rows, status = [], []
    for frequency in frequencies:
        resting = single_harmonic.resting_solutions(oscillator, damper, frequency)
        status.append(flag("balance_status", "solved"))
        try:
            impacting = single_harmonic.impacting_solutions(oscillator, damper, frequency)
        except ArithmeticError:
            impacting = single_harmonic.Solutions(*np.empty((3, 0)))
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
    columns = _solution_branches(amplitude, relative, phase, kinds)
    return {
        "amplitude": _table(columns, amplitude),
        "relative_amplitude": _table(columns, relative),
        "phase": _table(columns, phase),
        "growth_rate": _table(columns, growth),
        "stability": _table(
            columns, [stability(row) for row in growth], flag("stability", "absent")
        ),
        "kind": _table(columns, kinds, flag("kind", "absent")),
        "solution_count": [len(row) for row in amplitude],
        "balance_status": status,
    }


def _solution_branches(amplitude, relative, phase, kinds):
    """Return for each frequency the branches of the solutions with a damper.

    The first branches are those with impacts. The branches of motions in which the loose mass
    rests follow.
    """
    resting = flag("kind", "resting")
    found, begun = [np.empty(len(row), int) for row in kinds], 0
    for chosen in ([row != resting for row in kinds], [row == resting for row in kinds]):
        columns = branches_over(
            [
                np.hstack([_plane(a, t), _plane(b, t)])[where]
                for a, b, t, where in zip(amplitude, relative, phase, chosen, strict=True)
            ]
        )
        for row, where, column in zip(found, chosen, columns, strict=True):
            row[where] = begun + column
        begun += max((1 + row.max() for row in columns if len(row)), default=0)
    return found


def _rigid_table(oscillator, damper, frequencies):
    """Return the variables of the roots of (14)."""
    rigid = [
        single_harmonic.rigid_solutions(oscillator, damper, frequency) for frequency in frequencies
    ]
    walls = [
        np.where(each.pulling, flag("rigid_wall", "pulls"), flag("rigid_wall", "pushes"))
        for each in rigid
    ]
    columns = branches_over(
        [
            np.hstack([_plane(each.amplitude, each.phase), _plane(damper.clearance, each.phase)])
            for each in rigid
        ]
    )
    return {
        "rigid_amplitude": _table(columns, [each.amplitude for each in rigid]),
        "rigid_phase": _table(columns, [each.phase for each in rigid]),
        "rigid_wall": _table(columns, walls, flag("rigid_wall", "absent")),
    }
