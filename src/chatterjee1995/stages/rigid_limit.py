"""Errors of the rigid-impact model as functions of contact stiffness r1 and frequency.

The rigid-impact model has rigid walls and impacts that take no time. The exact system has compliant
contacts of stiffness r1. The quiet orbits of both, periodic motions of one cycle with two symmetric
contacts, are compared, stable or unstable. The compliant orbit is followed through a grid of
frequencies and r1. The rigid orbit does not depend on r1 and is followed in frequency. It is also
computed with corrected walls (`mended`), which account for the penetration at finite r1.

Z1 is the displacement of the primary mass. Multipliers are Floquet multipliers.
"""

from dataclasses import replace

import numpy as np

from chatterjee1995.methods.rigid_impacts import mended_orbit, rigid_orbit
from chatterjee1995.stages.logged_contacts import extreme_motions
from impact_damper.data.datasets import dataset, flag
from impact_damper.model.bounds import RUNS_RANGE, check_count
from impact_damper.model.checks import check_frequencies, check_frequency, check_increasing
from impact_damper.model.packed import pack
from impact_damper.model.parameters import check_damper, describe
from impact_damper.model.settling import check_settling
from impact_damper.orbits.compliant_orbits import compliant_orbit
from impact_damper.orbits.grid_following import Grid, follow_line

# Relative errors of max |Z1|. The dataset says from which stiffness the error is smaller.
THRESHOLDS = (0.01, 0.1)
# Largest distance of an orbit's state from the state predicted for it.
REACH = 0.1
# The order of the error in r1 is fitted from this r1 on, where contacts are short.
STIFF = 1e4


def rigid_limit(
    oscillator, damper, frequency, frequencies, stiffnesses, *, starts=16, seed=1995, settling=None
):
    """Compare rigid impacts with compliant contact at each frequency and stiffness.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper
    frequency : float
        Frequency W at which the quiet motion is searched for, with the damper's own r1.
    frequencies, stiffnesses : sequence of float
        Increasing W and r1 of the grid, dimensionless; at least two each.
    starts : int
        Number of random initial states from which the quiet motion is searched for.
    seed : int
    settling : Settling, optional

    Returns
    -------
    xarray.Dataset
        For each (frequency, stiffness) the compliant orbit, the rigid orbit with corrected walls
        (`mended`), errors and verdict (whether both orbits exist and are stable); for each
        `frequency` the rigid orbit, the exponents n with which errors decrease as r1^-n, and the
        stiffness above which the error of max |Z1| is below each of THRESHOLDS; errors at the
        damper's own r1 as scalars.

    Raises
    ------
    ArithmeticError
        If no start leads to a quiet motion, or its orbit cannot be followed into the grid.
    TypeError, ValueError
        If an argument is out of range; the message names it.
    """
    check_damper(damper)
    check_count("starts", starts, **RUNS_RANGE)
    frequency = check_frequency(frequency)
    frequencies = check_frequencies(frequencies, "two")
    stiffnesses = check_increasing("stiffnesses", stiffnesses, "two")
    settling = check_settling(settling)
    quiet = _quiet(oscillator, damper, frequency, starts, seed, settling)
    compliant, rigid, own = _grids(oscillator, damper, frequency, frequencies, stiffnesses, quiet)
    mended = _mended(oscillator, damper, frequencies, stiffnesses, rigid.orbits)
    data = (
        _columns("compliant", compliant.orbits, compliant.flags("compliant_status"))
        | _columns("rigid", rigid.orbits, rigid.flags("rigid_status"))
        | _columns("mended", *mended)
    )
    data |= _errors(data)
    data |= _needed(stiffnesses, data["rigid_error"])
    for name in ("rigid", "mended"):
        data[f"{name}_order"] = _orders(stiffnesses, data[f"{name}_error"])
    again = mended_orbit(oscillator, damper, frequency, own, REACH)[0]
    mended_size = np.nan if again is None else again.displacement
    data |= {
        "own_displacement": quiet.displacement,
        "own_error": own.displacement / quiet.displacement - 1,
        "own_mended_error": mended_size / quiet.displacement - 1,
        "own_decay_error": abs(own.multiplier) - abs(quiet.multiplier),
    }
    made = describe(oscillator, damper, settling)
    made |= {"frequency": frequency, "starts": starts, "seed": seed}
    coordinates = {
        "frequency": frequencies,
        "stiffness": stiffnesses,
        "threshold": list(THRESHOLDS),
    }
    return dataset(data, coordinates, made, "Rigid impacts against compliant contact")


def _quiet(oscillator, damper, frequency, starts, seed, settling):
    """Return the quiet orbit to which random starts lead.

    Raises
    ------
    ArithmeticError
        If no start leads to a quiet orbit.
    """
    motion, _ = extreme_motions(oscillator, damper, frequency, starts, seed, settling)
    if motion is not None and motion["period"] == 1:
        p = pack(oscillator, damper, frequency)
        orbit, _ = compliant_orbit(p, motion["state"], REACH)
        if orbit is not None:
            return orbit
    raise ArithmeticError(
        f"frequency = {frequency:g}: none of {starts} starts leads to a quiet motion, of period 1 "
        "with two symmetric contacts; more starts or another frequency may help"
    )


def _spread(correct, points, cell, own_point, orbit):
    """Follow `orbit` from `own_point` into a cell and then to all cells; return the `Grid`."""
    grid = Grid(points, correct)
    followed = follow_line(correct, own_point, points[cell], orbit)
    grid.put(cell, _reached(followed, "frequencies"))
    grid.spread()
    return grid


def _reached(followed, key):
    """Return the orbit at the end of the line along which it was followed.

    Raises
    ------
    ArithmeticError
        If the end was not reached. The message names `key`, the axis of the grid.
    """
    if not followed.arrived:
        raise ArithmeticError(f"{key}: the quiet motion cannot be followed into this grid")
    return followed.orbit


def _grids(oscillator, damper, frequency, frequencies, stiffnesses, quiet):
    """Return the grids of compliant and of rigid orbits, and the rigid orbit at `frequency`.

    The compliant orbits are followed from the orbit `quiet` at `frequency` and the damper's own r1.
    The rigid orbits are followed from the one nearest to the compliant orbit with the largest r1.
    """

    def compliant_at(point, guess):
        each = replace(damper, contact_stiffness=float(np.exp(point[1])))
        return compliant_orbit(pack(oscillator, each, point[0]), guess, REACH)

    def rigid_at(point, guess):
        return rigid_orbit(oscillator, damper, point[0], guess, REACH)

    logarithms = np.log(stiffnesses)
    own_point = np.array([frequency, np.log(damper.contact_stiffness)])
    stiffest = np.array([frequency, logarithms[-1]])
    stiff = _reached(follow_line(compliant_at, own_point, stiffest, quiet), "stiffnesses")
    own, _ = rigid_at(own_point, stiff.state)
    if own is None:
        raise ArithmeticError("stiffnesses: the rigid model has no orbit near the stiffest one")
    row = int(np.argmin(np.abs(frequencies - own_point[0])))
    column = int(np.argmin(np.abs(logarithms - own_point[1])))
    points = np.stack(np.meshgrid(frequencies, logarithms, indexing="ij"), axis=-1)
    compliant = _spread(compliant_at, points, (row, column), own_point, quiet)
    return compliant, _spread(rigid_at, frequencies[:, None], (row,), own_point[:1], own), own


def _mended(oscillator, damper, frequencies, stiffnesses, rigid):
    """Return the rigid orbits with corrected walls, keyed by cell, and the status of each cell.

    `rigid` are the rigid orbits, keyed by cell.
    """
    orbits = {}
    flags = np.full((len(frequencies), len(stiffnesses)), flag("mended_status", "not_attempted"))
    for (i,), orbit in rigid.items():
        for j, stiffness in enumerate(stiffnesses):
            each = replace(damper, contact_stiffness=float(stiffness))
            mended, status = mended_orbit(oscillator, each, frequencies[i], orbit, np.inf)
            flags[i, j] = flag("mended_status", status)
            if mended is not None:
                orbits[i, j] = mended
    return orbits, flags


def _columns(name, found, status):
    """Return the variables of a model: status, largest displacement and multiplier of each cell.

    `found` maps cells of the grid to orbits.
    """
    displacement, multiplier = np.full(status.shape, np.nan), np.full(status.shape, np.nan + 0j)
    for cell, orbit in found.items():
        displacement[cell], multiplier[cell] = orbit.displacement, orbit.multiplier
    return {
        f"{name}_status": status,
        f"{name}_displacement": displacement,
        f"{name}_multiplier_real": multiplier.real,
        f"{name}_multiplier_imaginary": multiplier.imag,
    }


def _errors(data):
    """Return relative errors of max |Z1|, errors of the modulus of the multiplier, and verdicts."""
    size = {
        name: np.hypot(data[f"{name}_multiplier_real"], data[f"{name}_multiplier_imaginary"])
        for name in ("compliant", "rigid")
    }
    rigid = size["rigid"][:, None]
    stable = size["compliant"] < 1, np.broadcast_to(rigid < 1, size["compliant"].shape)
    exists = np.isfinite(size["compliant"]), np.isfinite(rigid)
    chosen = {
        "both_stable": stable[0] & stable[1],
        "stability_differs": exists[0] & exists[1] & (stable[0] != stable[1]),
        "both_unstable": exists[0] & exists[1],
        "rigid_only": exists[1],
        "compliant_only": exists[0],
    }
    soft = data["compliant_displacement"]
    return {
        "rigid_error": data["rigid_displacement"][:, None] / soft - 1,
        "mended_error": data["mended_displacement"] / soft - 1,
        "decay_error": rigid - size["compliant"],
        "rigid_verdict": np.select(
            [np.broadcast_to(where, soft.shape) for where in chosen.values()],
            [flag("rigid_verdict", name) for name in chosen],
            flag("rigid_verdict", "neither"),
        ),
    }


def _needed(stiffnesses, errors):
    """Return the stiffness, interpolated, above which |error| stays below each threshold."""
    shape = len(THRESHOLDS), len(errors)
    needed, status = np.full(shape, np.nan), np.full(shape, flag("needed_status", "absent"))
    for j, row in enumerate(np.abs(errors)):
        known = np.flatnonzero(np.isfinite(row))
        if len(known) == 0 or known[-1] != len(row) - 1:
            continue
        for i, threshold in enumerate(THRESHOLDS):
            above = known[row[known] > threshold]
            if len(above) == 0:
                status[i, j] = flag("needed_status", "below_grid")
            elif above[-1] == len(row) - 1:
                status[i, j] = flag("needed_status", "above_grid")
            else:
                k = slice(above[-1], above[-1] + 2)
                place = np.interp(-np.log(threshold), -np.log(row[k]), np.log(stiffnesses[k]))
                needed[i, j], status[i, j] = np.exp(place), flag("needed_status", "found")
    return {"needed_stiffness": needed, "needed_status": status}


def _orders(stiffnesses, errors):
    """Return the exponents n of |error| ~ r1^-n, by least squares over r1 >= STIFF, or NaN."""
    orders = np.full(len(errors), np.nan)
    for i, row in enumerate(np.abs(errors)):
        used = np.isfinite(row) & (stiffnesses >= STIFF)
        if used.sum() > 2:
            orders[i] = -np.polyfit(np.log(stiffnesses[used]), np.log(row[used]), 1)[0]
    return orders
