"""Exact periodic orbits at any frequency, interpolated between neighbouring orbits of a branch.

In all functions here `free` is a dataset of branches without damper. An orbit is violent (high)
if its max |Z1| is more than half of max |Z1| of the free resonance at the same frequency.
"""

import numpy as np
import pandas as pd

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading.datasets import Missing
from impact_damper.data.datasets import flag, oscillator_of

SYMMETRIC = 1e-6  # largest `orbit_asymmetry` of a symmetric orbit
HALF = 0.5  # share of the free resonance above which an orbit is high
INTERPOLATED = ("frequency", "size", "amplitude", "loose")  # columns interpolated within a piece


def free_of(datasets, data):
    """Return the dataset of branches without damper whose oscillator is the same as in `data`."""
    wanted = oscillator_of(data)
    for free in reading.free(datasets, "branches").values():
        if oscillator_of(free) == wanted:
            return free
    raise Missing(f"There is no dataset of branches without a damper for h = {wanted.damping:g}")


def of_curve(datasets, name):
    """Return two datasets: branches of a curve, and branches of its oscillator without damper."""
    branches = reading.get(datasets, "branches", name)
    return branches, free_of(datasets, branches)


def pieces(branches) -> pd.DataFrame:
    """Return a table of pieces. A piece joins two successive orbits of a branch.

    `lower`, `upper`: the lower and the higher frequency W of the two orbits.
    `fewest`, `contacts`: the smaller and the larger of the two orbits' contacts per cycle.
    `restitution`: the least (speed after)/(speed before contact) among all contacts of both orbits.
    `frequency`, `size` (max |Z1|), `amplitude`, `loose`: means over the two orbits.
    `frequency_change`, `size_change`, `amplitude_change`, `loose_change`: the value at the second
    of the two orbits minus the value at the first.

    `amplitude` and `loose` are complex. The modulus of both is the amplitude of the first harmonic
    of Z1. The phase of `amplitude` is the phase of Z1 relative to Z2. The phase of `loose` is the
    phase of Z1 relative to Z1 - Z2, the displacement of the loose mass.
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
    frequency, contacts = along["frequency"][ends], branches.orbit_contacts.values[ends]
    table = {
        "branch": number[first],
        "period": branches.branch_period.values[number[first]],
        "lower": frequency.min(axis=0),
        "upper": frequency.max(axis=0),
        "stable": reading.largest_multiplier(branches)[ends].mean(axis=0) < 1,
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
    """Return the disjoint frequency ranges [lower, upper] that the pieces in a table cover."""
    merged = []
    for lower, upper in part[["lower", "upper"]].sort_values("lower").to_numpy():
        if merged and lower <= merged[-1][1]:
            merged[-1][1] = max(merged[-1][1], upper)
        else:
            merged.append([lower, upper])
    return merged


def covered(part, lower=-np.inf, upper=np.inf):
    """Return the total width in W that pieces cover between `lower` and `upper`."""
    return sum(np.ptp(np.clip(ends, lower, upper)) for ends in ranges(part))


def coexisting(part, column):
    """Return the total width in W over which pieces with different values of `column` overlap."""
    values = [ranges(same) for _, same in part.groupby(column)]
    if not values:
        return 0.0
    ends = np.unique([end for each in values for end in np.ravel(each)])
    middle = (ends[1:] + ends[:-1]) / 2
    count = sum(
        np.any([(lower < middle) & (middle < upper) for lower, upper in each], axis=0)
        for each in values
    )
    return float(np.sum(np.diff(ends)[count > 1]))


def crossings(part, frequency) -> pd.DataFrame:
    """Return a table of orbits at given frequencies, interpolated in `part`, a table of pieces."""
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
    """Return a table: for each frequency, the orbit in `part` (pieces) with the least max |Z1|."""
    rows = crossings(part, frequency)
    return rows.loc[rows.groupby("frequency")["size"].idxmin()]


def largest_sizes(part, frequency):
    """Return the largest max |Z1| of all pieces at each frequency, NaN where there is no piece."""
    return crossings(part, frequency).groupby("frequency")["size"].max().reindex(frequency).values


def resonance_fold(free):
    """Return W and max |Z1| of the fold at which the free resonance ends, or raise Missing."""
    fold = free.event_kind.values == flag("event_kind", "fold")
    fold &= free.branch_period.values[free.event_branch.values] == 1
    if not fold.any():
        raise Missing("The free resonance branch has no fold")
    k = np.argmax(np.where(fold, free.event_displacement.values, -np.inf))
    return float(free.event_value.values[k]), float(free.event_displacement.values[k])


def resonance(free, frequency):
    """Return max |Z1| of the free resonance at each frequency, NaN above the end of its branch."""
    end, _ = resonance_fold(free)
    part = pieces(free)
    sizes = largest_sizes(part[part.period == 1], frequency)
    return np.where(np.asarray(frequency) <= end, sizes, np.nan)


def high(branches, free):
    """Return a table of the pieces with stable violent orbits, of any period."""
    part = pieces(branches)
    part = part[part.stable]
    return part[part["size"] > HALF * resonance(free, part.frequency)]


def quiet(branches, free):
    """Return a table of the pieces with stable orbits of period 1 that are not violent."""
    part = pieces(branches)
    part = part[part.stable & (part.period == 1)]
    return part[~(part["size"] > HALF * resonance(free, part.frequency))]


def smallest_quiet(branches, free, frequency):
    """Return a table with the stable quiet orbit of least max |Z1| at each frequency."""
    orbits = smallest(quiet(branches, free), frequency)
    missing = np.setdiff1d(frequency, orbits.frequency)
    if len(missing):
        raise Missing(f"There is no stable quiet orbit at W = {missing[0]:.4g}")
    return orbits


def high_counterparts(design, branches, free) -> pd.DataFrame:
    """Return a table: for each stable violent solution of (7) the exact orbit nearest in amplitude.

    Equation (7) is harmonic balance with one harmonic. It approximates only symmetric orbits of
    period 1 with two contacts, so all other orbits are left out.
    """
    part = pieces(branches)
    part = part[(part.period == 1) & (part.asymmetry < SYMMETRIC)]
    part = part[(part.fewest == 2) & (part.contacts == 2)]
    violent = HALF * resonance(free, design.frequency)[:, None]
    amplitude = reading.stable_impacting(design).rename("a")
    solutions = amplitude.where(np.abs(amplitude) > violent).to_series().dropna().reset_index()
    pairs = solutions.reset_index().merge(crossings(part, design.frequency), on="frequency")
    difference = np.abs(pairs.amplitude.map(np.real) / pairs.a - 1)
    return pairs.loc[difference.groupby(pairs["index"]).idxmin()]


def subharmonic(free):
    """Return a table of pieces: the branch of free one-third subharmonics that is widest in W."""
    part = pieces(free)
    third = part[(part.period == 3) & (part.asymmetry < SYMMETRIC)]
    if third.empty:
        raise Missing("There is no one-third subharmonic without the damper")
    return max((one for _, one in third.groupby("branch")), key=covered)


def subharmonic_range(free):
    """Return the lowest and the highest frequency of the one-third subharmonic without damper."""
    part = subharmonic(free)
    return float(part.lower.min()), float(part.upper.max())


def stable_subharmonics(branches):
    """Return a table of the pieces with stable orbits of period 3, 6, 9, ... cycles."""
    part = pieces(branches)
    return part[part.stable & (part.period % 3 == 0)]
