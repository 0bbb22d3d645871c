"""Periodic orbits as labelled datasets: one orbit, one branch, or all branches of a response.

A branch is a curve of orbits along which one parameter varies. Orbits may be stable or not, of any
period, and touch the walls in any sequence.
"""

import sys
import warnings
from collections import Counter

import numpy as np
import xarray as xr
from tqdm import tqdm

from impact_damper.data.datasets import dataset, flag
from impact_damper.motions.simulate import COMPONENTS, carried_phase, check_state
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.orbit import STROBE
from impact_damper.orbits.random_search import COUNT, stable_orbits
from impact_damper.orbits.shooting import find_orbit
from impact_damper.orbits.switching import LEAVING, met_branch, other_branch
from impact_damper.stages.branch_datasets import branches_dataset, orbit_variables, torus_variables
from impact_damper.system.bounds import FREQUENCY_RANGE, check_count, check_number, shown
from impact_damper.system.checks import check_frequency, check_span
from impact_damper.system.families import LINEAR, family_of
from impact_damper.system.packed import FREQUENCY, pack
from impact_damper.system.parameters import describe

# `complete_branches` follows a branch for at most MOST_POINTS orbits in one direction, for periods
# beyond LONG for at most MOST_LONG. Branches of periods beyond LONGEST are followed only as far as
# they are stable. All these branches wind through chaos.
MOST_POINTS, MOST_LONG, LONG, LONGEST = 4000, 2000, 7, 9
# Longest period of branches to which `complete_branches` switches at a bifurcation: period
# doublings form infinite cascades.
LONGEST_SWITCHED = 4
# Bifurcations of one kind at frequencies that differ by less are the same.
NEAR = 1e-9


def periodic_orbit(oscillator, damper, frequency, state, *, period=1, phase=None):
    """Find the periodic orbit near a state by Newton's method.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequency : float
        Forcing frequency W, dimensionless.
    state : sequence of 4 floats, or 2 without a damper; or xarray.DataArray
        Z1, Z1', Z2, Z2' near the orbit.
    period : int
        Period n of the orbit in forcing cycles.
    phase : float, optional
        Phase W T of the state, radian. The default is the phase stored with the state of a dataset,
        and pi/2 for other states.

    Returns
    -------
    xarray.Dataset
        A dataset as from `orbit_branch` with the orbit as its single point. Its state is given at a
        phase at which no wall is touched. For each `contact`: wall, times and relative speeds.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range.
    ArithmeticError
        If Newton's method does not converge.

    Warns
    -----
    UserWarning
        If the orbit repeats after a divisor of the period.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> start = (0.006, 0.187, 0.002, -2.408)
    >>> orbit = idm.periodic_orbit(oscillator, damper, 2.0, state=start)
    >>> idm.decode(orbit.orbit_stability).item(), round(orbit.orbit_displacement.item(), 6)
    ('stable', 0.057734)
    """
    orbit = _checked_orbit(oscillator, damper, frequency, state, period, phase)
    if orbit.repeats_sooner():
        warnings.warn(
            f"period = {period}: the orbit found already repeats after a divisor of {period}",
            stacklevel=2,
        )
    log = orbit.contacts
    data = orbit_variables([(frequency, orbit)]) | {
        "orbit_branch": np.zeros(1, int),
        "contact_wall": log[:, 0],
        "contact_begin": log[:, 1],
        "contact_end": log[:, 2],
        "approach_velocity": log[:, 3],
        "departure_velocity": log[:, 4],
    }
    made = describe(oscillator, damper) | {
        "frequency": float(frequency),
        "period": int(period),
        "state": check_state(state, damper).tolist(),
    }
    return dataset(data, {"component": list(COMPONENTS)}, made, "Periodic orbit")


def orbit_branch(oscillator, damper, frequency, state, *, span, parameter="frequency", period=1):
    """Find the orbit near a state, and follow its branch over one parameter.

    Parameters
    ----------
    oscillator, damper, frequency, state, period
        As in `periodic_orbit`.
    span : tuple of float
        Least and greatest value of the parameter.
    parameter : str
        frequency, damping, cubic, force, unbalance, mass_ratio, clearance, restitution or
        contact_stiffness.

    Returns
    -------
    xarray.Dataset
        For each `point`, in order along the branch, an orbit: parameter, largest displacement,
        stability, multipliers, contacts, state and its phase, status, residual, error of
        Liouville's determinant. For each `event`: fold, symmetry breaking, period doubling,
        Neimark-Sacker bifurcation, or change of contacts, which is grazing (a contact appears in
        flight) or merging (two contacts with a wall become one). For each (branch, edge): the
        reason why the branch ends.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range.
    ArithmeticError
        If Newton's method finds no orbit near the state, or an orbit that repeats after a divisor
        of the period.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> start = (0.006, 0.187, 0.002, -2.408)
    >>> branch = idm.orbit_branch(oscillator, damper, 2.0, start, span=(1.8, 2.2))
    >>> idm.decode(branch.event_kind).values.tolist()
    []
    """
    given_span = span
    family, value, span = family_of(oscillator, damper, frequency, parameter, span)
    orbit = _checked_orbit(oscillator, damper, frequency, state, period, None)
    if orbit.repeats_sooner():
        raise ArithmeticError(
            f"period = {period}: the orbit near the state repeats after a divisor of {period}; "
            "give this as the period, or a state closer to the orbit"
        )
    branch = follow_branch(family, orbit, value, span)
    made = describe(oscillator, damper) | {
        "frequency": float(frequency),
        "period": int(period),
        "parameter": parameter,
        "state": check_state(state, damper).tolist(),
        "span": [float(end) for end in given_span],
    }
    back = float if parameter in LINEAR else np.exp
    return branches_dataset([branch], back, made, "Branch of periodic orbits")


def complete_branches(oscillator, damper, frequencies, motions, *, progress=None):
    """Follow every branch of orbits over frequency on which a settled motion lies.

    Stable orbits that lie on none of these branches are searched for from random states. Where a
    stable orbit loses its symmetry or doubles its period, the branch that begins there is followed
    too, up to period 4. So is the branch at which one of these branches ends.

    Parameters
    ----------
    oscillator : Oscillator
    damper : Damper or None
    frequencies : tuple of float
        Least and greatest frequency W, dimensionless.
    motions : list of xarray.Dataset
        Results of `frequency_response` or `subharmonic_suppression` for this oscillator and
        damper.
    progress : str, optional
        Title of a progress bar and of a summary on stderr; without it neither is shown.

    Returns
    -------
    xarray.Dataset
        As from `orbit_branch`, for all branches; `seeds`, the number of settled motions, and
        `seeds_lost`, the number of those motions from which Newton's method found no orbit;
        likewise `switches` and `switches_lost` for bifurcations where another branch leaves;
        `searches` from random states, those that found a stable orbit, and new branches. With a
        damper for each Neimark-Sacker point what splits off there, `torus_kind`, and the rotation
        number of a stable torus. Mirror
        images count as one branch. Motions without contacts are left out if there is a damper,
        because they are motions of the free oscillator.

    Raises
    ------
    TypeError, ValueError
        If an argument is of another type or out of range.

    Examples
    --------
    >>> import impact_damper as idm
    >>> oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
    >>> response = idm.frequency_response(oscillator, damper, [1.95, 2.0], starts=8)
    >>> found = idm.complete_branches(oscillator, damper, (1.9, 2.1), [response])
    >>> found.sizes["branch"]
    1
    """
    frequencies = check_span("frequencies", frequencies, **FREQUENCY_RANGE)
    if not isinstance(motions, list) or not all(isinstance(each, xr.Dataset) for each in motions):
        raise TypeError(f"motions = {shown(motions)}: must be a list of datasets of motions")

    packed = pack(oscillator, damper, frequencies[0])

    def family(value):
        p = packed.copy()
        p[FREQUENCY] = check_frequency(value)
        return p

    def follow(orbit, value):
        most = MOST_POINTS if orbit.periods <= LONG else MOST_LONG
        stable = orbit.periods > LONGEST
        return follow_branch(family, orbit, value, frequencies, most, stable=stable)

    branches, lost = [], 0
    seeds = sorted(_seeds(motions, damper), key=lambda seed: seed[:3])
    with tqdm(seeds, desc=progress, disable=progress is None, mininterval=1.0) as bar:
        for period, frequency, _, state in bar:
            orbit = find_orbit(family(frequency), state, period)
            if not orbit.converged or orbit.repeats_sooner():
                lost += 1
            elif not any(branch.holds(orbit, frequency) for branch in branches):
                branches.append(follow(orbit, frequency))
                bar.set_postfix(branches=len(branches))
    settled = len(branches)
    stable = list(stable_orbits(family, damper, frequencies))
    for value, orbit in stable:
        if not any(branch.holds(orbit, value) for branch in branches):
            branches.append(follow(orbit, value))
    searches = {"searches": COUNT, "searches_stable": len(stable)}
    searches["searches_new"] = len(branches) - settled
    switches, unswitched = _follow_others(branches, follow)
    if progress is not None:
        tqdm.write(f"{progress}: {_summary(branches, len(seeds), lost)}", file=sys.stderr)
    parameters = describe(oscillator, damper) | {"parameter": "frequency"}
    data = branches_dataset(branches, float, parameters, "Branches of periodic orbits")
    counts = {"seeds": len(seeds), "seeds_lost": lost}
    counts |= searches | {"switches": switches, "switches_lost": unswitched}
    counts |= torus_variables(branches) if damper is not None else {}
    return data.assign(dataset(counts, {}, parameters, data.attrs["title"]).variables)


def _follow_others(branches, follow):
    """Follow the branches that leave where a stable orbit loses its symmetry or doubles its period.

    The branches at which a branch ends are followed too. The new branches are appended to the list,
    and branches that begin on them are followed too.

    Returns
    -------
    sought, lost : int
        Number of such events, and of those at which no orbit of the other branch was found.
    """
    sought = lost = 0
    for branch in branches:
        for edge, kind in zip((0, -1), branch.ends, strict=True):
            if kind in LEAVING and branch.points[0].orbit.periods <= LONGEST_SWITCHED:
                met = met_branch(branch.points[edge], kind)
                if met and not any(_passes(each, kind, met) for each in branches):
                    branches.append(follow(met.orbit, met.value))
        for place, event in branch.events:
            periods = event.point.orbit.periods * (2 if event.kind == "period_doubling" else 1)
            beside = branch.points[max(place - 1, 0) : place + 2]
            if event.kind not in LEAVING or periods > LONGEST_SWITCHED or len(beside) < 3:
                continue
            if not any(point.orbit.stable for point in beside):
                continue
            sought += 1
            other = other_branch(event)
            if other is None:
                lost += 1
            elif not any(each.holds(other.orbit, other.value) for each in branches):
                branches.append(follow(other.orbit, other.value))
    return sought, lost


def _passes(branch, kind, point):
    """Return whether a branch holds the orbit of a point, or has an event of a kind there."""
    periods = point.orbit.periods
    there = [each.point for _, each in branch.events if each.kind == kind]
    near = any(abs(each.value - point.value) < NEAR for each in there)
    same = branch.points[0].orbit.periods == periods
    return same and (near or branch.holds(point.orbit, point.value))


def _summary(branches, seeds, lost):
    """Return a line with the numbers of motions, branches, orbits, events and ends of branches."""

    def listed(names):
        counts = Counter(names)
        return ", ".join(f"{name} {counts[name]}" for name in sorted(counts)) or "none"

    events = listed(event.kind for branch in branches for _, event in branch.events)
    ends = listed(end for branch in branches for end in branch.ends)
    orbits = sum(len(branch.points) for branch in branches)
    unlocated = sum(branch.lost for branch in branches)
    return (
        f"{seeds} motions, {lost} of them without an orbit; {len(branches)} branches with "
        f"{orbits} orbits; events: {events}; not located: {unlocated}; ends: {ends}"
    )


def _checked_orbit(oscillator, damper, frequency, state, period, phase):
    """Check arguments and return the orbit near a state; raises as `periodic_orbit` does."""
    check_count("period", period, most=1000)
    if phase is None:
        carried = carried_phase(state)
        phase = STROBE if carried is None else carried
    check_number("phase", phase, least=-1e6, most=1e6)
    p = pack(oscillator, damper, frequency)
    orbit = find_orbit(p, check_state(state, damper), period, phase)
    if not orbit.converged:
        raise ArithmeticError(
            f"no orbit of period {period} found: Newton's method left a residual of "
            f"{orbit.residual:.2g}; a state closer to it, or another period, is needed"
        )
    return orbit


def _seeds(motions, damper):
    """Yield period, frequency, max |Z1| and state of each settled motion in the datasets."""
    for data in motions:
        chosen = data["outcome"].values == flag("outcome", "settled")
        if damper is not None:
            chosen &= data["contacts"].values > 0
        for row, column in zip(*np.nonzero(chosen), strict=True):
            motion = data.isel(frequency=row, motion=column)
            yield (
                int(motion["period"]),
                float(motion["frequency"]),
                float(motion["maximum_displacement"]),
                motion["state"].values,
            )
