"""What the claims and the tables read from the exact branches of periodic orbits."""

import numpy as np
import pandas as pd

from impact_damper.claims import extract
from impact_damper.claims.claim import Missing
from impact_damper.data.datasets import flag, oscillator_of

SYMMETRIC = 1e-6
HALF = 0.5  # an orbit is high if it exceeds this share of the free resonance branch
ALONG = ("frequency", "size", "amplitude", "loose")


def free_of(datasets, data):
    """Branches of the free oscillator that a damper of `data` is attached to, or raise Missing."""
    wanted = oscillator_of(data)
    for free in datasets.get("free_branches", {}).values():
        if oscillator_of(free) == wanted:
            return free
    raise Missing(f"There is no dataset of the stage free_branches with h = {wanted.damping:g}")


def of_curve(datasets, name):
    """Branches with the damper of a curve, and those of its free oscillator, or raise Missing."""
    branches = extract.get(datasets, "branches", name)
    return branches, free_of(datasets, branches)


def pieces(branches) -> pd.DataFrame:
    """Branches cut into pieces, each from one orbit to the next.

    Returns
    -------
    pandas.DataFrame
        By piece: branch and period; W at both its ends, the lower and the upper; in its middle
        W, max |Z1| (size) and the first harmonic of Z1 as a complex number, by the phase of Z2
        (amplitude) and by that of x2 (loose), and by how much these change along it; largest
        modulus of a multiplier in the middle, and whether it is stable, which changes at orbits
        only; fewest and most contacts a period; asymmetry; least ratio of the speeds after and
        before a contact.
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
    """Ranges of W over which some pieces extend, in order; those that touch are one."""
    found = []
    for lower, upper in part[["lower", "upper"]].sort_values("lower").to_numpy():
        if found and lower <= found[-1][1]:
            found[-1][1] = max(found[-1][1], upper)
        else:
            found.append([lower, upper])
    return found


def covered(part, lower=-np.inf, upper=np.inf):
    """Width of W, within bounds, over which some pieces extend."""
    return sum(np.ptp(np.clip(ends, lower, upper)) for ends in ranges(part))


def crossings(part, frequency) -> pd.DataFrame:
    """Some pieces where they pass given frequencies, by a straight line between their ends."""
    frequency = np.atleast_1d(np.asarray(frequency, float))
    there = frequency[:, None] >= part.lower.to_numpy()
    there &= frequency[:, None] <= part.upper.to_numpy()
    place, row = np.nonzero(there)
    found = part.iloc[row].reset_index(drop=True)
    away = frequency[place] - found.frequency
    change = found.frequency_change.to_numpy()
    share = np.divide(away, change, out=np.zeros(len(found)), where=change != 0)
    for name in ALONG:
        found[name] = found[name] + share * found[f"{name}_change"]
    return found.assign(frequency=frequency[place])


def smallest(part, frequency) -> pd.DataFrame:
    """The crossing of least size at each frequency that some pieces pass, in their order."""
    found = crossings(part, frequency)
    return found.loc[found.groupby("frequency")["size"].idxmin()]


def largest(part, frequency):
    """Largest size of some pieces at each frequency, NaN where there is none."""
    return crossings(part, frequency).groupby("frequency")["size"].max().reindex(frequency).values


def resonance_fold(free):
    """Frequency and size at which the free resonance branch ends, or raise Missing."""
    fold = free.event_kind.values == flag("event_kind", "fold")
    fold &= free.branch_period.values[free.event_branch.values] == 1
    if not fold.any():
        raise Missing("The free resonance branch has no fold")
    k = np.argmax(np.where(fold, free.event_displacement.values, -np.inf))
    return float(free.event_value.values[k]), float(free.event_displacement.values[k])


def resonance(free, frequency):
    """Size of the free resonance branch at each frequency, NaN above its fold."""
    end, _ = resonance_fold(free)
    part = pieces(free)
    sizes = largest(part[part.period == 1], frequency)
    return np.where(np.asarray(frequency) <= end, sizes, np.nan)


def above_half(part, free):
    """Whether pieces exceed half of the free resonance branch."""
    return part["size"] > HALF * resonance(free, part.frequency)


def high(branches, free):
    """Pieces of stable orbits above half of the free resonance branch, of any period."""
    part = pieces(branches)
    part = part[part.stable]
    return part[above_half(part, free)]


def quiet(branches, free):
    """Pieces of stable orbits of period 1 that are not high."""
    part = pieces(branches)
    part = part[part.stable & (part.period == 1)]
    return part[~above_half(part, free)]


def counterparts(design, branches) -> pd.DataFrame:
    """Impacting solutions of (7), each with the nearest orbit of its kind at the same frequency.

    Returns
    -------
    pandas.DataFrame
        By solution its frequency, amplitude `a`, whether it is `balance_stable` and whether it
        is the `least` one there; beside it the crossing of symmetric orbits of period 1 with two
        contacts, stable or not, whose amplitude is nearest, and their relative difference.
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
    """The counterparts of the stable solutions of (7) above half of the free resonance branch."""
    pairs = counterparts(design, branches)
    limit = HALF * resonance(free, pairs.frequency)
    return pairs[pairs.balance_stable & (np.abs(pairs.a) > limit)]


def subharmonic(free):
    """Pieces of the free one-third subharmonic, or raise Missing.

    It is symmetric and of period 3; of several such branches it is the one of the widest range.
    """
    part = pieces(free)
    third = part[(part.period == 3) & (part.asymmetry < SYMMETRIC)]
    if third.empty:
        raise Missing("There is no one-third subharmonic without the damper")
    return max((one for _, one in third.groupby("branch")), key=covered)


def subharmonic_range(free):
    """Frequencies of the folds between which the free one-third subharmonic exists."""
    part = subharmonic(free)
    return float(part.lower.min()), float(part.upper.max())


def stable_subharmonics(branches):
    """Pieces of stable orbits whose period is a multiple of 3."""
    part = pieces(branches)
    return part[part.stable & (part.period % 3 == 0)]
