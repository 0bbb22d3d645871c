"""Numbers that test claims 10 and 18, on the one-third subharmonic with and without damper."""

import numpy as np

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits

# Curves: two with light dampers, one with a heavy damper, one with low damping.
LIGHT, HEAVY, LOW_DAMPING = reading.BY_MASS[:2], reading.BY_MASS[2], "figure_08"
AS_LARGE = 0.95  # a subharmonic counts as unchanged if max |Z1| / (free max |Z1|) is at least this


def _remaining(datasets, name):
    """Return a dict of numbers on the stable orbits of period 3, 6, 9, ... cycles of a curve.

    `band`: width in W of the suppression band by harmonic balance.
    `in_band`: width in W over which such orbits exist, in the suppression band.
    `between`: width in W over which such orbits exist, in the range of the free subharmonic.
    `ratio`: the largest (max |Z1| of such an orbit)/(max |Z1| of the free subharmonic), at equal W.
    `ratio_in_band`: the largest value of this fraction at all W in the suppression band.
    """
    branches, free = orbits.of_curve(datasets, name)
    part = orbits.stable_subharmonics(branches)
    edges = reading.band_edges(reading.get(datasets, "harmonic_balance", name))
    ratio = part["size"] / orbits.largest_sizes(orbits.subharmonic(free), part.frequency)
    return {
        "band": np.ptp(edges),
        "in_band": orbits.covered(part, *edges),
        "between": orbits.covered(part, *orbits.subharmonic_range(free)),
        "ratio_in_band": ratio[part.frequency.between(*edges)].max(),
        "ratio": ratio.max(),
    }


def reappearance(datasets):
    """Return numbers that test claim 10: only a light damper removes the one-third subharmonic."""
    light = [_remaining(datasets, name) for name in LIGHT]
    heavy, low = _remaining(datasets, HEAVY), _remaining(datasets, LOW_DAMPING)
    return {
        "light": max(each["in_band"] for each in light),
        "light_anywhere": max(each["between"] for each in light),
        "light_ratio": np.fmax.reduce([each["ratio"] for each in light]),
        "heavy": heavy["in_band"],
        "ratio": heavy["ratio_in_band"],
        "low_damping": low["in_band"] / low["band"],
        "low_ratio": low["ratio_in_band"],
    }


def by_damping(datasets):
    """Return numbers that test claim 18: a damper reduces subharmonics more if damping h is low."""
    low, high = (_reduction(datasets, name) for name in (LOW_DAMPING, reading.BY_MASS[0]))
    return {
        "fall": low["fall"] / high["fall"],
        "relative": low["relative"] / high["relative"],
        "relative_low": low["relative"],
        "relative_high": high["relative"],
        "unchanged": low["unchanged"],
        "unchanged_high": high["unchanged"],
    }


def _reduction(datasets, name):
    """Return a dict: how much the damper of a curve reduces the one-third subharmonic.

    `fall`: reduction of max |Z1| by the damper, averaged over W and starts. A start that leads to
    no subharmonic counts as max |Z1| = 0.
    `relative`: `fall` divided by the mean of max |Z1| without the damper.
    `unchanged`: (width in W of the unchanged subharmonic)/(width in W of the free subharmonic).
    A subharmonic with the damper is unchanged if it is stable and its max |Z1| is at least
    AS_LARGE times max |Z1| of the free subharmonic.
    """
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
        "unchanged": orbits.covered(alike, *ends) / np.ptp(ends),
    }
