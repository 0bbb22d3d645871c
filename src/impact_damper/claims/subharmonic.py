"""Claims on the one-third subharmonic: 10 and 18 (section 3, figures 5 and 8)."""

import numpy as np

from impact_damper.claims import extract
from impact_damper.claims.claim import Claim, Missing, Number
from impact_damper.datasets import flag

LIGHT, HEAVY, LOW_DAMPING = extract.BY_MASS[:2], extract.BY_MASS[2], "figure_08"


def in_free_range(curve):
    """The part of a subharmonic dataset in which the free one exists, or raise Missing."""
    lower, upper = curve.free_subharmonic_frequency.values
    if not upper > lower:
        raise Missing("There is no one-third subharmonic without the damper")
    return extract.within(curve, lower, upper)


def width(curve, part):
    """Width of W in which, in a part of a dataset, a subharmonic exists with the damper."""
    return float(part.damped_subharmonic.notnull().sum()) * extract.spacing(curve)


def reappearance(datasets):
    """Numbers of claim 10."""
    curves = extract.select(datasets, "subharmonic", (*LIGHT, HEAVY))
    bands = [
        extract.within(curve, *extract.band_edges(design))
        for curve, design in zip(
            curves, extract.select(datasets, "design", (*LIGHT, HEAVY)), strict=True
        )
    ]
    widths = [width(curve, band) for curve, band in zip(curves, bands, strict=True)]
    light, heavy = curves[: len(LIGHT)], bands[-1]
    return {
        "light": max(widths[: len(LIGHT)]),
        "light_anywhere": max(width(curve, curve) for curve in light),
        "light_ratio": float(np.max([curve.subharmonic_ratio.max() for curve in light])),
        "heavy": widths[-1],
        "ratio": float(heavy.subharmonic_ratio.where(heavy.subharmonic_ratio > 0).max()),
        "reached": float(heavy.switched_share.sel(switched_motion="subharmonic").max()),
    }


def expected(curve):
    """Mean amplitude of subharmonics that a start leads to, 0 for another motion."""
    third = extract.is_outcome(curve, "settled") & (curve.period % 3 == 0)
    share = curve.share / curve.share.sum("motion")
    return (share * curve.maximum_displacement).where(third, 0.0).sum("motion")


def unchanged(curve):
    """Share of the frequencies at which the damper leaves a subharmonic as it was."""
    return float((curve.suppression == flag("suppression", "unchanged")).mean())


def by_damping(datasets):
    """Numbers of claim 18."""
    low, high = (
        in_free_range(extract.get(datasets, "subharmonic", name))
        for name in (LOW_DAMPING, extract.BY_MASS[0])
    )
    falls = [float((curve.free_subharmonic - expected(curve)).mean()) for curve in (low, high)]
    relative = [
        fall / float(curve.free_subharmonic.mean())
        for fall, curve in zip(falls, (low, high), strict=True)
    ]
    return {
        "fall": falls[0] / falls[1],
        "low": falls[0],
        "high": falls[1],
        "relative": relative[0] / relative[1],
        "unchanged": unchanged(low),
        "unchanged_high": unchanged(high),
        "range": np.ptp(low.free_subharmonic_frequency.values)
        / np.ptp(high.free_subharmonic_frequency.values),
    }


CLAIMS = (
    Claim(
        "10",
        "A properly designed damper removes the one-third subharmonic; a larger rm lets it "
        "reappear within the band with a much lower amplitude.",
        "section 3, figure 5",
        "Removed: no motion whose period is a multiple of 3 in the suppression band, figures 5 (a) "
        "and (b), and in full nowhere. Reappears: figure 5 (c). Much lower: half at most. Followed "
        "motions count, however small their basins.",
        (
            Number(
                "light",
                "width of W in the band with such a motion, (a) and (b)",
                most=0,
                decisive=True,
            ),
            Number("light_anywhere", "width of W with such a motion anywhere, (a) and (b)", most=0),
            Number("light_ratio", "its largest amplitude over that without the damper"),
            Number(
                "heavy",
                "width of W in the band with such a motion, (c)",
                least=0.005,
                decisive=True,
            ),
            Number(
                "ratio",
                "its largest amplitude over that without the damper, (c)",
                most=0.5,
                decisive=True,
            ),
            Number("reached", "largest share of runs from the free subharmonic that lead to it"),
        ),
        reappearance,
    ),
    Claim(
        "18",
        "The control of the one-third subharmonic is more prominent at lower h.",
        "section 3, figure 8",
        "By how much its amplitude falls, where starts lead, mean over the free range: h = 0.107 "
        "against h = 0.215, both rm = 0.12. Motions with small basins, which only following "
        "finds, are counted apart.",
        (
            Number(
                "fall",
                "mean fall of the amplitude for h = 0.107 over that for h = 0.215",
                least=1,
                decisive=True,
            ),
            Number("relative", "the same, each relative to the free amplitude", least=1),
            Number("low", "mean fall for h = 0.107"),
            Number("high", "mean fall for h = 0.215"),
            Number("range", "free range of W for h = 0.107 over that for h = 0.215"),
            Number(
                "unchanged",
                "share of the range for h = 0.107 in which a subharmonic of at "
                "least 95 % of the free amplitude is left",
                most=0.05,
            ),
            Number("unchanged_high", "the same for h = 0.215"),
        ),
        by_damping,
    ),
)
