"""Numbers that the claims and the tables need from the branches of exact periodic orbits.

A branch is a sequence of orbits along the forcing frequency W. It is cut into pieces, each from one
orbit to the next. Within a piece all quantities are interpolated linearly, so that branches can be
evaluated at any frequency. Free means without the damper. The free resonance branch consists of the
large motions of period 1 without the damper; it ends at a fold, where it turns back in W. An orbit
is high (violent) if its largest displacement exceeds half of that on this branch at the same W. A
quiet orbit has period 1 and is not high. `branches` and `free` are datasets of the stage
`branches`, with and without the damper. The one-third subharmonic is a motion of period 3.

Z1 is the displacement of the primary mass.
"""

import numpy as np
import pandas as pd

from chatterjee1995.claims import extract
from chatterjee1995.claims.claim import Missing
from impact_damper.data.datasets import flag, oscillator_of

# Half a period later the state of a symmetric orbit has changed its sign, up to this difference.
SYMMETRIC = 1e-6
# An orbit is high if its max |Z1| exceeds this share of max |Z1| on the free resonance branch.
HALF = 0.5
# Columns of `pieces` that are interpolated within a piece.
INTERPOLATED = ("frequency", "size", "amplitude", "loose")


def free_of(datasets, data):
    """Return the branches without damper for the oscillator of `data`, or raise Missing."""
    wanted = oscillator_of(data)
    for free in extract.free(datasets, "branches").values():
        if oscillator_of(free) == wanted:
            return free
    raise Missing(f"There is no dataset of branches without a damper for h = {wanted.damping:g}")


def of_curve(datasets, name):
    """Return the branches of dataset `name` and of its free oscillator, or raise Missing."""
    branches = extract.get(datasets, "branches", name)
    return branches, free_of(datasets, branches)


def pieces(branches) -> pd.DataFrame:
    """Cut branches into pieces, each from one orbit to the next.

    Returns
    -------
    pandas.DataFrame
        One row for each piece, with the columns

        - branch, period (in forcing cycles);
        - lower, upper: ends in W;
        - frequency: W in the middle of the piece, like the next three columns; four more columns,
          whose names end in `_change`, hold the differences between the ends of the piece;
        - size: max |Z1|;
        - amplitude: first harmonic of Z1 as a complex number; its phase is relative to Z2, the
          displacement of the primary mass relative to the loose mass;
        - loose: the same number with the phase relative to the displacement x2 of the loose mass;
        - multiplier: largest modulus of a Floquet multiplier, averaged over both ends;
        - stable: whether `multiplier` is below 1;
        - fewest, contacts: least and largest number of contacts per period at the ends;
        - asymmetry: largest asymmetry at the ends;
        - restitution: least ratio of the speed after a contact to the speed before it.
    """
    number = branches.orbit_branch.values
    first = np.flatnonzero(number[1:] == number[:-1])
    ends = np.stack([first, first + 1])
    size = branches.orbit_amplitude.values
    along = {
        "frequency": branches.followed_value.values,
        "size": branches.orbit_displacement.values,
        "amplitude": size * np.exp(1j * branches.orbit_phase_relative.values),
        "loose": size * np.exp(1j * branches.orbit_phase_loose.values),
    }
    modulus = np.hypot(branches.orbit_multiplier_real, branches.orbit_multiplier_imaginary)
    multiplier = modulus.max("multiplier").values[ends].mean(axis=0)
    frequency, contacts = along["frequency"][ends], branches.orbit_contacts.values[ends]
    table = {
        "branch": number[first],
        "period": branches.branch_period.values[number[first]],
        "lower": frequency.min(axis=0),
        "upper": frequency.max(axis=0),
        "multiplier": multiplier,
        "stable": multiplier < 1,
        "fewest": contacts.min(axis=0),
        "contacts": contacts.max(axis=0),
        "asymmetry": branches.orbit_asymmetry.values[ends].max(axis=0),
        "restitution": branches.orbit_restitution.values[ends].min(axis=0),
    }
    for name, values in along.items():
        table[name] = values[ends].mean(axis=0)
        table[f"{name}_change"] = np.diff(values[ends], axis=0)[0]
    return pd.DataFrame(table)


def ranges(part):
    """Return a list of the ascending ranges [lower, upper] of W that pieces cover.

    `part` are rows of `pieces`. Ranges that touch are merged.
    """
    merged = []
    for lower, upper in part[["lower", "upper"]].sort_values("lower").to_numpy():
        if merged and lower <= merged[-1][1]:
            merged[-1][1] = max(merged[-1][1], upper)
        else:
            merged.append([lower, upper])
    return merged


def covered(part, lower=-np.inf, upper=np.inf):
    """Return the total width of the ranges that pieces cover within W from `lower` to `upper`."""
    return sum(np.ptp(np.clip(ends, lower, upper)) for ends in ranges(part))


def coexisting(part, column):
    """Return the total width in W in which pieces with different values in a column overlap."""
    values = [ranges(same) for _, same in part.groupby(column)]
    ends = np.unique([end for each in values for end in np.ravel(each)])
    middle = (ends[1:] + ends[:-1]) / 2
    count = sum(
        np.any([(lower < middle) & (middle < upper) for lower, upper in each], axis=0)
        for each in values
    )
    return float(np.sum(np.diff(ends)[count > 1])) if values else 0.0


def crossings(part, frequency) -> pd.DataFrame:
    """Interpolate pieces at frequencies.

    The result has the columns of `pieces`, and a row for each frequency and each piece that
    contains it. The columns INTERPOLATED hold the interpolated values.
    """
    frequency = np.atleast_1d(np.asarray(frequency, float))
    inside = frequency[:, None] >= part.lower.to_numpy()
    inside &= frequency[:, None] <= part.upper.to_numpy()
    index, row = np.nonzero(inside)
    rows = part.iloc[row].reset_index(drop=True)
    distance = frequency[index] - rows.frequency
    change = rows.frequency_change.to_numpy()
    share = np.divide(distance, change, out=np.zeros(len(rows)), where=change != 0)
    for name in INTERPOLATED:
        rows[name] = rows[name] + share * rows[f"{name}_change"]
    return rows.assign(frequency=frequency[index])


def smallest(part, frequency) -> pd.DataFrame:
    """Return the row of `crossings` with the smallest size at each frequency.

    A frequency that lies in no piece has no row.
    """
    rows = crossings(part, frequency)
    return rows.loc[rows.groupby("frequency")["size"].idxmin()]


def largest_sizes(part, frequency):
    """Return the largest size of the pieces at each frequency; NaN if no piece contains it."""
    return crossings(part, frequency).groupby("frequency")["size"].max().reindex(frequency).values


def resonance_fold(free):
    """Return frequency and size (max |Z1|) at the fold of the free resonance branch.

    Raises
    ------
    Missing
        If there is no fold.
    """
    fold = free.event_kind.values == flag("event_kind", "fold")
    fold &= free.branch_period.values[free.event_branch.values] == 1
    if not fold.any():
        raise Missing("The free resonance branch has no fold")
    k = np.argmax(np.where(fold, free.event_displacement.values, -np.inf))
    return float(free.event_value.values[k]), float(free.event_displacement.values[k])


def resonance(free, frequency):
    """Return max |Z1| on the free resonance branch at each frequency; NaN above its fold."""
    end, _ = resonance_fold(free)
    part = pieces(free)
    sizes = largest_sizes(part[part.period == 1], frequency)
    return np.where(np.asarray(frequency) <= end, sizes, np.nan)


def above_half(part, free):
    """Return the mask of the pieces that are high (see HALF)."""
    return part["size"] > HALF * resonance(free, part.frequency)


def high(branches, free):
    """Return the pieces of stable orbits of any period that are high."""
    part = pieces(branches)
    part = part[part.stable]
    return part[above_half(part, free)]


def quiet(branches, free):
    """Return the pieces of stable quiet orbits."""
    part = pieces(branches)
    part = part[part.stable & (part.period == 1)]
    return part[~above_half(part, free)]


def counterparts(design, branches) -> pd.DataFrame:
    """Pair solutions of harmonic balance (7) with the nearest exact orbit at the same frequency.

    Only solutions with contact are paired (impacting solutions). Only orbits are considered that
    one harmonic can approximate: symmetric orbits of period 1 with two contacts, stable or not.
    `design` is a dataset of the stage `harmonic_balance`.

    Returns
    -------
    pandas.DataFrame
        One row for each solution with such an orbit. Columns: `frequency`; `a`, the amplitude of
        the solution; `balance_stable`, whether the solution is stable; `least`, whether |a| is the
        smallest at this frequency; the columns of `crossings` for the orbit; `difference`, the
        relative difference between `a` and the first harmonic of the orbit.
    """
    part = pieces(branches)
    alike = part[
        (part.period == 1)
        & (part.asymmetry < SYMMETRIC)
        & (part.fewest == part.contacts)
        & (part.contacts == 2)
    ]
    impacting = design.kind == flag("kind", "impacting")
    size = np.abs(design.amplitude).where(impacting)
    solutions = pd.DataFrame(
        {
            "frequency": np.broadcast_to(design.frequency.values[:, None], size.shape).ravel(),
            "a": design.amplitude.values.ravel(),
            "balance_stable": (design.stability == flag("stability", "stable")).values.ravel(),
            "least": (size == size.min("solution")).values.ravel(),
        }
    )[impacting.values.ravel()]
    pairs = solutions.reset_index().merge(crossings(alike, design.frequency), on="frequency")
    pairs["difference"] = np.abs(pairs.amplitude.map(np.real) / pairs.a - 1)
    return pairs.loc[pairs.groupby("index").difference.idxmin()]


def high_counterparts(design, branches, free):
    """Return the rows of `counterparts` for stable solutions whose |a| is high (see HALF)."""
    pairs = counterparts(design, branches)
    limit = HALF * resonance(free, pairs.frequency)
    return pairs[pairs.balance_stable & (np.abs(pairs.a) > limit)]


def subharmonic(free):
    """Return the pieces of the one-third subharmonic without damper, or raise Missing.

    If there are several branches of symmetric orbits of period 3, the one with the widest range of
    W is taken.
    """
    part = pieces(free)
    third = part[(part.period == 3) & (part.asymmetry < SYMMETRIC)]
    if third.empty:
        raise Missing("There is no one-third subharmonic without the damper")
    return max((one for _, one in third.groupby("branch")), key=covered)


def subharmonic_range(free):
    """Return the frequencies of both folds that bound the one-third subharmonic without damper."""
    part = subharmonic(free)
    return float(part.lower.min()), float(part.upper.max())


def stable_subharmonics(branches):
    """Return the pieces of stable orbits whose period is a multiple of 3."""
    part = pieces(branches)
    return part[part.stable & (part.period % 3 == 0)]
