"""Errors of max |Z1| if walls are taken as rigid, without and with a correction ("mended")."""

from dataclasses import replace

import numpy as np

from chatterjee1995.methods.grid_following import Grid, follow_line
from chatterjee1995.methods.quiet_orbits import compliant_orbit
from chatterjee1995.methods.rigid_impacts import mended_orbit, rigid_orbit
from chatterjee1995.stages.contact_model import extreme_motions
from impact_damper.data.datasets import dataset, flag
from impact_damper.data.variables import register
from impact_damper.model.packed import pack
from impact_damper.model.parameters import describe

register(
    """
stiffness | stiffness | | r1 | contact stiffness
rigid_error | frequency stiffness | | | relative error of max |Z1| if walls are taken as rigid
mended_error | frequency stiffness | | | relative error of max |Z1| with corrected rigid walls
rigid_verdict | frequency stiffness | | | which of the compliant and rigid orbits were found, and
  whether their stability agrees
  : both_stable 0, both_unstable 1, stability_differs 2, rigid_only 3, compliant_only 4,
  : neither 5
threshold | threshold | | | relative error of max |Z1| that is allowed
needed_stiffness | threshold frequency | | r1 | contact stiffness above which rigid_error is below
  the threshold
needed_status | threshold frequency | | | whether needed_stiffness lies within, below or above the
  grid
  : absent -1, found 0, below_grid 1, above_grid 2
rigid_order | frequency | | | exponent n of rigid_error ~ r1^-n for short contacts
mended_order | frequency | | | exponent n of mended_error ~ r1^-n for short contacts
own_displacement | | | max |Z1| | largest displacement with the damper's own r1
own_error | | | | relative error of own_displacement if walls are taken as rigid
own_mended_error | | | | relative error of own_displacement with corrected rigid walls
    """
)

THRESHOLDS = (0.01, 0.1)  # relative errors of max |Z1| for which the needed stiffness is stored
REACH = 0.1  # largest distance of an orbit's state from the first guess
STIFF = 1e4  # least r1 in the fit of error ~ r1^-n, which holds for short contacts


def rigid_limit(
    oscillator, damper, frequency, frequencies, stiffnesses, *, starts=16, seed=1995, settling
):
    """Return a dataset: errors of max |Z1| if walls are taken as rigid.

    Random starts at `frequency` lead to the quiet motion, which is then followed to all
    `frequencies` and `stiffnesses`. Raise ArithmeticError if no quiet motion is found.
    """
    frequencies, stiffnesses = np.array(frequencies, float), np.array(stiffnesses, float)
    quiet = _quiet(oscillator, damper, frequency, starts, seed, settling)
    compliant, rigid, own = _grids(oscillator, damper, frequency, frequencies, stiffnesses, quiet)
    data = _errors(oscillator, damper, frequencies, stiffnesses, compliant.orbits, rigid.orbits)
    data |= _needed(stiffnesses, data["rigid_error"])
    for name in ("rigid", "mended"):
        data[f"{name}_order"] = _orders(stiffnesses, data[f"{name}_error"])
    again = mended_orbit(oscillator, damper, frequency, own, REACH)[0]
    mended_size = np.nan if again is None else again.displacement
    data |= {
        "own_displacement": quiet.displacement,
        "own_error": own.displacement / quiet.displacement - 1,
        "own_mended_error": mended_size / quiet.displacement - 1,
    }
    made = describe(oscillator, damper, settling)
    made |= {"frequency": float(frequency), "starts": starts, "seed": seed}
    coordinates = {"frequency": frequencies, "stiffness": stiffnesses}
    coordinates["threshold"] = list(THRESHOLDS)
    return dataset(data, coordinates, made, "Rigid impacts against compliant contact")


def _quiet(oscillator, damper, frequency, starts, seed, settling):
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
    grid = Grid(points, correct)
    followed = follow_line(correct, own_point, points[cell], orbit)
    grid.orbits[cell] = _reached(followed, "frequencies")
    grid.spread()
    return grid


def _reached(followed, key):
    if not followed.arrived:
        raise ArithmeticError(f"{key}: the quiet motion cannot be followed into this grid")
    return followed.orbit


def _grids(oscillator, damper, frequency, frequencies, stiffnesses, quiet):

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


def _errors(oscillator, damper, frequencies, stiffnesses, compliant, rigid):
    shape = len(frequencies), len(stiffnesses)
    plain, mended = np.full(shape, np.nan), np.full(shape, np.nan)
    verdict = np.full(shape, flag("rigid_verdict", "neither"))
    for i, j in np.ndindex(shape):
        soft, hard = compliant.get((i, j)), rigid.get((i,))
        verdict[i, j] = flag("rigid_verdict", _verdict(soft, hard))
        if soft is None or hard is None:
            continue
        plain[i, j] = hard.displacement / soft.displacement - 1
        each = replace(damper, contact_stiffness=float(stiffnesses[j]))
        better, _ = mended_orbit(oscillator, each, frequencies[i], hard, np.inf)
        if better is not None:
            mended[i, j] = better.displacement / soft.displacement - 1
    return {"rigid_error": plain, "mended_error": mended, "rigid_verdict": verdict}


def _verdict(soft, hard):
    if soft is None or hard is None:
        return "neither" if soft is hard else "rigid_only" if soft is None else "compliant_only"
    stable = [abs(orbit.multiplier) < 1 for orbit in (soft, hard)]
    return "both_stable" if all(stable) else "stability_differs" if any(stable) else "both_unstable"


def _needed(stiffnesses, errors):
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
    orders = np.full(len(errors), np.nan)
    for i, row in enumerate(np.abs(errors)):
        used = np.isfinite(row) & (stiffnesses >= STIFF)
        if used.sum() > 2:
            orders[i] = -np.polyfit(np.log(stiffnesses[used]), np.log(row[used]), 1)[0]
    return orders
