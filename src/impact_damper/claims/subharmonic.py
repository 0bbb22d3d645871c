"""Claims 10 and 18, on the one-third subharmonic (section 3, figures 5 and 8).

Without the damper (free) it is a motion of period 3; with it, any whose period is a multiple of 3.
"""

import numpy as np

from impact_damper.claims import exact_orbits, extract
from impact_damper.claims.claim import Claim, Measure
from impact_damper.claims.findings import motions as motions_findings

LIGHT, HEAVY, LOW_DAMPING = extract.BY_MASS[:2], extract.BY_MASS[2], "figure_08"
AS_LARGE = 0.95  # least ratio of amplitudes at which the subharmonic counts as unchanged


def largest_ratio(part, free):
    """Largest ratio of max |Z1| of pieces to that of the free subharmonic; NaN without pieces."""
    sizes = exact_orbits.largest_sizes(exact_orbits.subharmonic(free), part.frequency)
    return (part["size"] / sizes).max()


def reappearance(datasets):
    """Measures of claim 10: the damper removes the subharmonic; a larger rm lets it reappear."""
    in_band, anywhere, ratios = [], [], []
    for name in (*LIGHT, HEAVY):
        branches, free = exact_orbits.of_curve(datasets, name)
        part = exact_orbits.stable_subharmonics(branches)
        lower, upper = extract.band_edges(extract.get(datasets, "harmonic_balance", name))
        in_band.append(exact_orbits.covered(part, lower, upper))
        anywhere.append(exact_orbits.covered(part, *exact_orbits.subharmonic_range(free)))
        inside = part.frequency.between(lower, upper) if name == HEAVY else slice(None)
        ratios.append(largest_ratio(part[inside], free))
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
    """Mean max |Z1| of random starts at each frequency; a start without subharmonic counts as 0."""
    third = extract.is_outcome(curve, "settled") & (curve.period % 3 == 0)
    share = curve.motion_starts / curve.motion_starts.sum("motion")
    return (share * curve.maximum_displacement).where(third, 0.0).sum("motion")


def unchanged(branches, free):
    """Share of the free subharmonic's range of W where the damper leaves one about as large."""
    lower, upper = exact_orbits.subharmonic_range(free)
    part = exact_orbits.stable_subharmonics(branches)
    part = part[part.frequency.between(lower, upper)]
    alike = part["size"] >= AS_LARGE * exact_orbits.largest_sizes(
        exact_orbits.subharmonic(free), part.frequency
    )
    return exact_orbits.covered(part[alike], lower, upper) / (upper - lower)


def by_damping(datasets):
    """Measures of claim 18: the subharmonic is reduced more at lower h."""
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
        number="10",
        text="A properly designed damper removes the one-third subharmonic; a larger rm lets it "
        "reappear within the band with a much lower amplitude.",
        source="section 3, figure 5",
        interpretation="Removed means that no stable orbit whose period is a multiple of 3 exists "
        "in the suppression band of harmonic balance, for figures 5 (a) and (b); for full "
        "agreement none may exist between the folds of the free subharmonic either. Figure 5 (c) "
        "has the larger rm. Much lower means at most half of the free subharmonic at the same W. "
        "All stable orbits count, however few starts lead to them.",
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
                "largest amplitude of such an orbit over the free subharmonic, (a) and (b)",
            ),
            Measure(
                "heavy",
                "width in W of the part of the band with such an orbit, (c)",
                least=0.005,
                decisive=True,
            ),
            Measure(
                "ratio",
                "largest amplitude of such an orbit over the free subharmonic, (c)",
                most=0.5,
                decisive=True,
            ),
            Measure(
                "reached",
                "largest share of starts on the free subharmonic that lead to such an orbit",
            ),
        ),
        evidence=reappearance,
        finding=motions_findings.reappearance,
        figures=("figure_05c",),
    ),
    Claim(
        number="18",
        text="The control of the one-third subharmonic is more prominent at lower h.",
        source="section 3, figure 8",
        interpretation="More prominent means that the amplitude of the subharmonic, averaged over "
        "random starts and over W between the folds of the free subharmonic, falls by more at h = "
        "0.107 than at h = 0.215, both with rm = 0.12. A start that leads to another motion "
        "counts as 0. Full agreement also requires a larger fall relative to the free amplitude, "
        "and that no stable subharmonic remains nearly unchanged, however few starts lead to it.",
        measures=(
            Measure(
                "fall",
                "mean decrease of the amplitude for h = 0.107 over the decrease for h = 0.215",
                least=1,
                decisive=True,
            ),
            Measure("relative", "ratio of the decreases relative to the free amplitudes", least=1),
            Measure("low", "mean decrease for h = 0.107"),
            Measure("high", "mean decrease for h = 0.215"),
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
