"""Claims on the one-third subharmonic: 10 and 18 (section 3, figures 5 and 8)."""

import numpy as np

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Claim, Number

LIGHT, HEAVY, LOW_DAMPING = extract.BY_MASS[:2], extract.BY_MASS[2], "figure_08"
AS_LARGE = 0.95


def compared(part, free):
    """Largest ratio of the size of some pieces to that of the free subharmonic, NaN if none."""
    sizes = exact.largest(exact.subharmonic(free), part.frequency)
    return (part["size"] / sizes).max()


def reappearance(datasets):
    """Numbers of claim 10."""
    in_band, anywhere, ratios = [], [], []
    for name in (*LIGHT, HEAVY):
        branches, free = exact.of_curve(datasets, name)
        part = exact.stable_subharmonics(branches)
        lower, upper = extract.band_edges(extract.get(datasets, "design", name))
        in_band.append(exact.covered(part, lower, upper))
        anywhere.append(exact.covered(part, *exact.subharmonic_range(free)))
        inside = part.frequency.between(lower, upper) if name == HEAVY else slice(None)
        ratios.append(compared(part[inside], free))
    heavy = extract.within(extract.get(datasets, "subharmonic", HEAVY), lower, upper)
    return {
        "light": max(in_band[: len(LIGHT)]),
        "light_anywhere": max(anywhere[: len(LIGHT)]),
        "light_ratio": np.nanmax([*ratios[: len(LIGHT)], 0.0]),
        "heavy": in_band[-1],
        "ratio": ratios[-1],
        "reached": float(heavy.switched_share.sel(switched_motion="subharmonic").max()),
    }


def expected(curve):
    """Mean amplitude of subharmonics that a start leads to, 0 for another motion."""
    third = extract.is_outcome(curve, "settled") & (curve.period % 3 == 0)
    share = curve.share / curve.share.sum("motion")
    return (share * curve.maximum_displacement).where(third, 0.0).sum("motion")


def unchanged(branches, free):
    """Share of the free subharmonic's range in which one with the damper is as large."""
    lower, upper = exact.subharmonic_range(free)
    part = exact.stable_subharmonics(branches)
    part = part[part.frequency.between(lower, upper)]
    alike = part["size"] >= AS_LARGE * exact.largest(exact.subharmonic(free), part.frequency)
    return exact.covered(part[alike], lower, upper) / (upper - lower)


def by_damping(datasets):
    """Numbers of claim 18."""
    names = (LOW_DAMPING, extract.BY_MASS[0])
    curves = [exact.of_curve(datasets, name) for name in names]
    ends = [exact.subharmonic_range(free) for _, free in curves]
    low, high = (
        extract.within(extract.get(datasets, "subharmonic", name), *pair)
        for name, pair in zip(names, ends, strict=True)
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
        "unchanged": unchanged(*curves[0]),
        "unchanged_high": unchanged(*curves[1]),
        "range": np.ptp(ends[0]) / np.ptp(ends[1]),
    }


CLAIMS = (
    Claim(
        "10",
        "A properly designed damper removes the one-third subharmonic; a larger rm lets it "
        "reappear within the band with a much lower amplitude.",
        "section 3, figure 5",
        "Removed: no stable orbit whose period is a multiple of 3 in the suppression band by "
        "harmonic balance, figures 5 (a) and (b), and in full nowhere between the folds of the "
        "free one. Reappears: figure 5 (c). Much lower: half at most of the free one at the same "
        "W. All stable orbits count, however small their basins.",
        (
            Number(
                "light",
                "width of W in the band with such an orbit, (a) and (b)",
                most=0,
                decisive=True,
            ),
            Number(
                "light_anywhere",
                "width of W between the folds of the free one with such an orbit, (a) and (b)",
                most=0,
            ),
            Number("light_ratio", "its largest amplitude over that without the damper"),
            Number(
                "heavy",
                "width of W in the band with such an orbit, (c)",
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
        "against h = 0.215, both rm = 0.12. Free range: between the folds. Stable orbits whose "
        "period is a multiple of 3 are counted apart, for they may have small basins.",
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
