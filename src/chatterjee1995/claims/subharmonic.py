"""Claims 10 and 18, on the one-third subharmonic (section 3, figures 5 and 8).

Without the damper (free) the subharmonic is a motion of period 3, that is of three forcing cycles.
It exists between two folds, the frequencies W at which its branch turns back. With the damper every
motion whose period is a multiple of 3 is called a subharmonic. h is the damping of the oscillator
and rm the mass ratio. The suppression band is the range of W in which no motion with the damper is
large. A start is a random initial state.

Z1 is the displacement of the primary mass.
"""

from typing import NamedTuple

import numpy as np

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import Claim, Measure
from chatterjee1995.claims.findings import motions as motions_findings

# Dampers of light and heavy loose masses, and one on an oscillator with low damping.
LIGHT, HEAVY, LOW_DAMPING = extract.BY_MASS[:2], extract.BY_MASS[2], "figure_08"
# The subharmonic counts as unchanged by the damper if its amplitude is at least AS_LARGE times the
# free one.
AS_LARGE = 0.95
# The stable part of a branch between the folds counts as narrow if its width in W is below NARROW.
NARROW = 0.001


class Remaining(NamedTuple):
    """Stable orbits with a damper whose period is a multiple of 3.

    Attributes
    ----------
    band : float
        Width in W of the suppression band of harmonic balance.
    in_band, between_folds : float
        Widths in W over which such orbits exist: in the band, and between the folds of the free
        subharmonic.
    ratio_in_band, ratio, narrow_ratio : float
        Largest ratio of max |Z1| to that of the free subharmonic: in the band; on branches whose
        stable part between the folds is not narrow; on branches whose stable part is narrow. NaN
        without such orbits.
    narrow_width : float
        Width of the stable part between the folds on the branch with `narrow_ratio`; 0 without
        such a branch.
    """

    band: float
    in_band: float
    between_folds: float
    ratio_in_band: float
    ratio: float
    narrow_ratio: float
    narrow_width: float


def remaining(datasets, name) -> Remaining:
    """Return the stable subharmonics that remain with the damper of a curve, or raise Missing."""
    branches, free = exact_orbits.of_curve(datasets, name)
    part = exact_orbits.stable_subharmonics(branches)
    edges = extract.band_edges(extract.get(datasets, "harmonic_balance", name))
    folds = exact_orbits.subharmonic_range(free)
    sizes = exact_orbits.largest_sizes(exact_orbits.subharmonic(free), part.frequency)
    ratio = part["size"] / sizes
    width = {branch: exact_orbits.covered(one, *folds) for branch, one in part.groupby("branch")}
    narrow = part.branch.map(width) < NARROW
    return Remaining(
        band=float(np.ptp(edges)),
        in_band=exact_orbits.covered(part, *edges),
        between_folds=exact_orbits.covered(part, *folds),
        ratio_in_band=ratio[part.frequency.between(*edges)].max(),
        ratio=ratio[~narrow].max(),
        narrow_ratio=ratio[narrow].max(),
        narrow_width=width[part.branch[ratio[narrow].idxmax()]] if ratio[narrow].any() else 0.0,
    )


def reappearance(datasets):
    """Return the measures of claim 10: dampers of small rm remove the subharmonic, others do not.

    By this claim the subharmonic reappears, much smaller, if rm is larger.
    """
    light = [remaining(datasets, name) for name in LIGHT]
    heavy, low = remaining(datasets, HEAVY), remaining(datasets, LOW_DAMPING)
    narrow = max(light, key=lambda each: np.nan_to_num(each.narrow_ratio))
    edges = extract.band_edges(extract.get(datasets, "harmonic_balance", HEAVY))
    switched = extract.within(extract.get(datasets, "subharmonic", HEAVY), *edges).switched_share
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


def third(curve):
    """Return the mask of the settled motions whose period is a multiple of 3.

    `curve` is a dataset of the stage `subharmonic`.
    """
    return extract.is_outcome(curve, "settled") & (curve.period % 3 == 0)


def expected(curve):
    """Return the mean max |Z1| over the random starts at each frequency.

    A start that does not lead to a subharmonic counts as 0. `curve` is a dataset as for `third`.
    """
    share = curve.motion_starts / curve.motion_starts.sum("motion")
    return (share * curve.maximum_displacement).where(third(curve), 0.0).sum("motion")


def unchanged(branches, free):
    """Return the share of the range between the folds in which a subharmonic is unchanged.

    `branches` and `free` are datasets of orbits with and without the damper.
    """
    lower, upper = exact_orbits.subharmonic_range(free)
    part = exact_orbits.stable_subharmonics(branches)
    part = part[part.frequency.between(lower, upper)]
    alike = part["size"] >= AS_LARGE * exact_orbits.largest_sizes(
        exact_orbits.subharmonic(free), part.frequency
    )
    return exact_orbits.covered(part[alike], lower, upper) / (upper - lower)


def by_damping(datasets):
    """Return the measures of claim 18: the subharmonic is reduced more at lower h."""
    names = (LOW_DAMPING, extract.BY_MASS[0])
    curves = [exact_orbits.of_curve(datasets, name) for name in names]
    ends = [exact_orbits.subharmonic_range(free) for _, free in curves]
    low, high = (
        extract.within(extract.get(datasets, "subharmonic", name), *pair)
        for name, pair in zip(names, ends, strict=True)
    )
    falls = [float((curve.free_subharmonic - expected(curve)).mean()) for curve in (low, high)]
    relative = [
        fall / float(curve.free_subharmonic.mean())
        for fall, curve in zip(falls, (low, high), strict=True)
    ]
    starts = [float(extract.share_of_starts(curve, third(curve)).mean()) for curve in (low, high)]
    return {
        "fall": falls[0] / falls[1],
        "low": falls[0],
        "high": falls[1],
        "relative": relative[0] / relative[1],
        "relative_low": relative[0],
        "relative_high": relative[1],
        "starts": starts[0],
        "starts_high": starts[1],
        "unchanged": unchanged(*curves[0]),
        "unchanged_high": unchanged(*curves[1]),
        "range": np.ptp(ends[0]) / np.ptp(ends[1]),
    }


CLAIMS = (
    Claim(
        number="10",
        text="A properly designed damper removes the one-third subharmonic; a larger rm lets it "
        "reappear within the band with a much lower amplitude.",
        source="section 3, figure 5",
        interpretation="Removed means that no stable orbit whose period is a multiple of 3 exists "
        "in the suppression band of harmonic balance, for figures 5 (a) and (b); for full "
        "agreement none may exist between the folds of the free subharmonic either. Figure 5 (c) "
        "has the larger rm. Much lower means at most half of the free subharmonic at the same W. "
        "All stable orbits count, however few starts lead to them. Branches that are stable over "
        "less than 0.001 in W are reported by themselves. The claim is on figure 5, with h = "
        "0.215; the damper of figure 8, with h = 0.107, is reported as well.",
        measures=(
            Measure(
                "light",
                "width in W of the part of the band with such an orbit, (a) and (b)",
                most=0,
                decisive=True,
            ),
            Measure(
                "light_anywhere",
                "width in W of the range between the folds with such an orbit, (a) and (b)",
                most=0,
            ),
            Measure(
                "light_ratio",
                "largest amplitude of such an orbit between the folds over the free subharmonic, "
                "(a) and (b)",
            ),
            Measure("narrow_ratio", "the same ratio on branches stable over less than 0.001 in W"),
            Measure("narrow_width", "width in W over which the branch with this ratio is stable"),
            Measure(
                "heavy",
                "width in W of the part of the band with such an orbit, (c)",
                least=0.005,
                decisive=True,
            ),
            Measure(
                "ratio",
                "largest amplitude of such an orbit in the band over the free subharmonic, (c)",
                most=0.5,
                decisive=True,
            ),
            Measure("heavy_ratio", "the same ratio between the folds, (c)"),
            Measure(
                "reached",
                "largest share of starts on the free subharmonic that lead to such an orbit in the "
                "band, (c)",
            ),
            Measure("low_damping", "share of the band of figure 8, h = 0.107, with such an orbit"),
            Measure(
                "low_ratio",
                "largest amplitude of such an orbit in the band over the free subharmonic, figure "
                "8",
            ),
        ),
        evidence=reappearance,
        finding=motions_findings.reappearance,
        figures=("figure_05c", "orbits_05c", "figure_05a"),
    ),
    Claim(
        number="18",
        text="The control of the one-third subharmonic is more prominent at lower h.",
        source="section 3, figure 8",
        interpretation="The paper calls the control prominently displayed at lower h. This is "
        "read as a fall of the amplitude of the subharmonic, relative to the free amplitude, that "
        "is larger at h = 0.107 than at h = 0.215, both with rm = 0.12, by 5 % at least. In units "
        "of Z1 the fall is larger because the free amplitude is, which is no property of the "
        "control. A relative fall cannot exceed 100 %: where it is nearly complete at both h, the "
        "verdict says only that the control is not more complete at lower h. The fall is averaged "
        "over random starts and over W between the folds of the free subharmonic; a start that "
        "leads to another motion counts as 0. Full agreement also requires that no stable "
        "subharmonic remains nearly unchanged, however few starts lead to it.",
        measures=(
            Measure(
                "relative",
                "mean decrease of the amplitude relative to the free amplitude, h = 0.107 over h = "
                "0.215",
                least=1.05,
                decisive=True,
            ),
            Measure("fall", "ratio of the mean decreases in units of Z1"),
            Measure("low", "mean decrease for h = 0.107"),
            Measure("high", "mean decrease for h = 0.215"),
            Measure("relative_low", "mean decrease relative to the free amplitude for h = 0.107"),
            Measure("relative_high", "mean decrease relative to the free amplitude for h = 0.215"),
            Measure("starts", "mean share of random starts that lead to a subharmonic, h = 0.107"),
            Measure("starts_high", "the same share for h = 0.215"),
            Measure("range", "width of the free range for h = 0.107 over the width for h = 0.215"),
            Measure(
                "unchanged",
                "share of the free range for h = 0.107 with a subharmonic of at least 95 % of the "
                "free amplitude",
                most=0.05,
            ),
            Measure(
                "unchanged_high", "share of the free range for h = 0.215 with such a subharmonic"
            ),
        ),
        evidence=by_damping,
        finding=motions_findings.subharmonic_by_damping,
        figures=("figure_08",),
    ),
)
