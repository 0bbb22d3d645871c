"""Evidence for claims 10 and 18, on the one-third subharmonic with and without damper."""

from typing import NamedTuple

import numpy as np

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits

# Dampers of light and heavy loose masses, and one on an oscillator with low damping.
LIGHT, HEAVY, LOW_DAMPING = reading.BY_MASS[:2], reading.BY_MASS[2], "figure_08"
AS_LARGE = 0.95  # least share of the free amplitude of a subharmonic that counts as unchanged
NARROW = 0.001  # width in W below which the stable part of a branch counts as narrow


class Remaining(NamedTuple):
    """Stable orbits with a damper whose period is a multiple of 3.

    Widths in W of the suppression band of (7) (`band`), and over which such orbits exist in the
    band and between the folds of the free subharmonic. Largest ratios of max |Z1| to the free
    subharmonic: in the band, on branches that are not narrow, and on narrow ones, with the width
    of the narrow branch. A ratio without orbits is NaN.
    """

    band: float
    in_band: float
    between_folds: float
    ratio_in_band: float
    ratio: float
    narrow_ratio: float
    narrow_width: float


def _remaining(datasets, name) -> Remaining:
    """Return the stable subharmonics that remain with the damper of a curve, or raise Missing."""
    branches, free = orbits.of_curve(datasets, name)
    part = orbits.stable_subharmonics(branches)
    edges = reading.band_edges(reading.get(datasets, "harmonic_balance", name))
    folds = orbits.subharmonic_range(free)
    ratio = part["size"] / orbits.largest_sizes(orbits.subharmonic(free), part.frequency)
    width = {branch: orbits.covered(one, *folds) for branch, one in part.groupby("branch")}
    narrow = part.branch.map(width) < NARROW
    return Remaining(
        band=float(np.ptp(edges)),
        in_band=orbits.covered(part, *edges),
        between_folds=orbits.covered(part, *folds),
        ratio_in_band=ratio[part.frequency.between(*edges)].max(),
        ratio=ratio[~narrow].max(),
        narrow_ratio=ratio[narrow].max(),
        narrow_width=width[part.branch[ratio[narrow].idxmax()]] if ratio[narrow].any() else 0.0,
    )


def reappearance(datasets):
    """Return the numbers of claim 10: light dampers remove the subharmonic, heavy ones do not."""
    light = [_remaining(datasets, name) for name in LIGHT]
    heavy, low = _remaining(datasets, HEAVY), _remaining(datasets, LOW_DAMPING)
    narrow = max(light, key=lambda each: np.nan_to_num(each.narrow_ratio))
    edges = reading.band_edges(reading.get(datasets, "harmonic_balance", HEAVY))
    switched = reading.within(reading.get(datasets, "subharmonic", HEAVY), *edges).switched_share
    return {
        "light": max(each.in_band for each in light),
        "light_anywhere": max(each.between_folds for each in light),
        "light_ratio": np.fmax.reduce([each.ratio for each in light]),
        "narrow_ratio": narrow.narrow_ratio,
        "narrow_width": narrow.narrow_width,
        "heavy": heavy.in_band,
        "ratio": heavy.ratio_in_band,
        "heavy_ratio": heavy.ratio,
        "reached": float(switched.sel(switched_motion="subharmonic").max()),
        "low_damping": low.in_band / low.band,
        "low_ratio": low.ratio_in_band,
    }


def by_damping(datasets):
    """Return the numbers of claim 18: the subharmonic is reduced more at lower h."""
    low, high = (_reduction(datasets, name) for name in (LOW_DAMPING, reading.BY_MASS[0]))
    return {
        "fall": low["fall"] / high["fall"],
        "low": low["fall"],
        "high": high["fall"],
        "relative": low["relative"] / high["relative"],
        "relative_low": low["relative"],
        "relative_high": high["relative"],
        "starts": low["starts"],
        "starts_high": high["starts"],
        "unchanged": low["unchanged"],
        "unchanged_high": high["unchanged"],
        "range": low["range"] / high["range"],
    }


def _reduction(datasets, name):
    """Return by how much a damper lowers the subharmonic, on average between its folds."""
    branches, free = orbits.of_curve(datasets, name)
    ends = orbits.subharmonic_range(free)
    curve = reading.within(reading.get(datasets, "subharmonic", name), *ends)
    third = reading.is_outcome(curve, "settled") & (curve.period % 3 == 0)
    share = curve.motion_starts / curve.motion_starts.sum("motion")
    expected = (share * curve.maximum_displacement).where(third, 0.0).sum("motion")
    fall = float((curve.free_subharmonic - expected).mean())
    part = orbits.stable_subharmonics(branches)
    part = part[part.frequency.between(*ends)]
    size = orbits.largest_sizes(orbits.subharmonic(free), part.frequency)
    alike = part[part["size"] >= AS_LARGE * size]
    return {
        "fall": fall,
        "relative": fall / float(curve.free_subharmonic.mean()),
        "starts": float(reading.share_of_starts(curve, third).mean()),
        "unchanged": orbits.covered(alike, *ends) / np.ptp(ends),
        "range": np.ptp(ends),
    }
