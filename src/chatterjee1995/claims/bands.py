"""Claims 4 and 16, on the suppression band (sections 3 and 4, figures 3, 5 and 10).

The suppression band is the range of the forcing frequency W around the peak frequency Wp, up to the
end of the resonance branch without the damper, in which no motion with the damper is violent. A
motion is violent if its largest displacement exceeds half of that on the resonance branch. A quiet
orbit is a periodic motion of one forcing cycle that is not violent. The reduction is 1 minus the
ratio of the amplitudes with and without the damper. omega_l is the linear frequency, rm the mass
ratio, e the restitution and d0 the clearance. Numbers in brackets are equations of the paper.

Z1 is the displacement of the primary mass.
"""

import numpy as np

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import Claim, Measure, Missing
from chatterjee1995.claims.coexistence import design_multipliers
from chatterjee1995.claims.findings import balance as balance_findings
from chatterjee1995.claims.suppression import high_motions, suppression_band


def growth(widths):
    """Return the smallest ratio of a width to the width before it in a sequence."""
    widths = np.asarray(widths, float)
    return float(np.min(widths[1:] / widths[:-1]))


def widening(datasets):
    """Return the measures of claim 4: the band widens with omega_l, with rm and with lower e."""
    captions = extract.select(datasets, "harmonic_balance", extract.CAPTIONS)
    rules = extract.select(datasets, "harmonic_balance", extract.RULES)
    masses = extract.select(datasets, "harmonic_balance", extract.BY_MASS)
    existing = [suppression_band(datasets, name) for name in extract.BY_MASS]
    steps = [
        wider.least_width / band.width for band, wider in zip(existing, existing[1:], strict=False)
    ]
    inelastic = suppression_band(datasets, extract.INELASTIC)
    return {
        "linear_rule": growth([design.band_width for design in rules]),
        "linear": growth([design.band_width for design in captions]),
        "relative_rule": growth([design.band_width / design.peak_frequency for design in rules]),
        "relative": growth([design.band_width / design.peak_frequency for design in captions]),
        "mass": growth([design.band_width for design in masses]),
        "existing": np.min(steps),
        "restitution": inelastic.least_width / existing[1].width,
        "reduction_rule": 100 * np.ptp([float(design.reduction) for design in rules]),
        "reduction": 100 * np.ptp([float(design.reduction) for design in captions]),
        "orbit_reduction_rule": 100 * np.ptp(remaining(datasets, extract.RULES)),
        "orbit_reduction": 100 * np.ptp(remaining(datasets, extract.CAPTIONS)),
        "designs_stable": np.mean(design_multipliers(datasets) < 1),
    }


def remaining(datasets, names):
    """Return max |Z1| of exact quiet orbits at Wp, divided by that of the resonance without damper.

    The orbits, one for each dataset in `names`, may be stable or not.
    """
    orbits = extract.select(datasets, "design_orbit", names)
    return [
        float(extract.design_point(orbit).orbit_displacement)
        / exact_orbits.resonance_fold(exact_orbits.free_of(datasets, orbit))[1]
        for orbit in orbits
    ]


def accuracy(datasets):
    """Return the measures of claim 16: harmonic balance gives the band's amplitude and width."""
    widths, shares, factors, harmonics, violent = [], [], [], [], []
    for name in extract.ELASTIC:
        design = extract.get(datasets, "harmonic_balance", name)
        branches, free = exact_orbits.of_curve(datasets, name)
        lower, upper = extract.band_edges(design)
        widths.append(largest_difference(upper - lower, suppression_band(datasets, name)))
        estimate = np.abs(extract.quiet_balance(extract.within(design, lower, upper)))
        orbits = smallest_quiet_orbits(branches, free, estimate.frequency)
        size, first = orbits["size"].to_numpy(), np.abs(orbits.amplitude.to_numpy())
        shares.append(float(np.max(np.abs(size - estimate.values)) / design.peak_amplitude))
        factors.append(factor(size.mean(), float(estimate.mean())))
        response = extract.within(extract.get(datasets, "response", name), lower, upper)
        high = high_motions(response, free)
        violent.append(float(extract.share_of_starts(response, high).max()))
        harmonics.append(factor(first.mean(), float(estimate.mean())))
    return {
        "typical": np.median(widths),
        "width": np.max(widths),
        "typical_factor": np.median(factors),
        "factor": np.max(factors),
        "least_factor": np.min(factors),
        "harmonic": np.max(harmonics),
        "share": np.max(shares),
        "violent": max(violent),
    }


def factor(one, other):
    """Return the larger of two positive numbers over the smaller."""
    return max(one / other, other / one)


def largest_difference(width, band):
    """Return the largest relative difference of a width to the widths that a `Band` allows.

    The lower edge of the band is known only to lie within a range.
    """
    return max(abs(width / band.width - 1), abs(width / band.least_width - 1))


def smallest_quiet_orbits(branches, free, frequency):
    """Return the smallest stable quiet orbit at each frequency, or raise Missing.

    `branches` and `free` are datasets of periodic orbits with and without the damper. The result
    has the columns of `exact_orbits.pieces`.
    """
    orbits = exact_orbits.smallest(exact_orbits.quiet(branches, free), frequency)
    missing = np.setdiff1d(frequency, orbits.frequency)
    if len(missing):
        raise Missing(f"There is no stable quiet orbit at W = {missing[0]:.4g}")
    return orbits


CLAIMS = (
    Claim(
        number="4",
        text="The suppression band widens with omega_l, with rm and with lower e; the percentage "
        "reduction in it barely depends on omega_l.",
        source="sections 3 and 4, figures 3, 5 and 10",
        interpretation="The width is a range of W, as in the figures of the paper; the width over "
        "Wp is reported too. For omega_l it is taken by (7) alone, as figure 3 is, with d0 by "
        "(19) and by the captions. For rm it is taken by (7) and by the motions that exist, for e "
        "(1 and 0.75, with rm = 0.25) by the motions that exist. The reduction is 100 % times 1 - "
        "|a|/(free amplitude) at Wp. Barely means by at most 10 percentage points. For full "
        "agreement the quiet motion, on which the reduction rests, must exist: at Wp its exact "
        "orbit must be stable in all designs of figure 3.",
        measures=(
            Measure(
                "linear_rule",
                "least ratio of the width by (7) to the width at the next smaller omega_l, d0 by "
                "(19)",
                least=1,
                decisive=True,
            ),
            Measure("linear", "the same ratio, d0 of the captions", least=1, decisive=True),
            Measure("relative_rule", "the same ratio of the widths over Wp, d0 by (19)"),
            Measure("relative", "the same ratio of the widths over Wp, d0 of the captions"),
            Measure(
                "designs_stable",
                "share of designs of figure 3 with a stable exact quiet orbit at Wp",
                least=1,
            ),
            Measure(
                "mass",
                "least ratio of the width by (7) to the width at the next smaller rm",
                least=1,
                decisive=True,
            ),
            Measure(
                "existing",
                "lower bound of this ratio for rm by the motions that exist",
                least=1,
                decisive=True,
            ),
            Measure(
                "restitution",
                "lower bound of the width for e = 0.75 over the width for e = 1, by the motions "
                "that exist",
                least=1,
                decisive=True,
            ),
            Measure(
                "reduction_rule",
                "largest minus smallest reduction by (7) over omega_l in percentage points, d0 by "
                "(19)",
                most=10,
                decisive=True,
            ),
            Measure("reduction", "the same difference, d0 of the captions", most=10, decisive=True),
            Measure(
                "orbit_reduction_rule",
                "the same difference by max |Z1| of the exact quiet orbits, d0 by (19)",
                most=10,
            ),
            Measure(
                "orbit_reduction",
                "the same difference by max |Z1| of the exact quiet orbits, d0 of the captions",
                most=10,
            ),
        ),
        evidence=widening,
        finding=balance_findings.band_width,
        figures=("figure_03a", "figure_03b", "figure_03c", "figure_05a", "figure_10"),
    ),
    Claim(
        number="16",
        text="Harmonic balance estimates the amplitude in the suppression band and the band's "
        "width accurately.",
        source="section 3, figure 5",
        interpretation="Accurately means within 25 %. The median over the dampers of figures 5 "
        "and 8 decides for the width; for full agreement the amplitude and all dampers must "
        "agree. The width by (7) is compared with the width by the motions that exist, violent "
        "chaos included, lasting or not. Chaos was looked for at steps of W only. Where chaos ends "
        "the band, the edge may lie anywhere within a step, and the edge at which the widths agree "
        "least counts. The amplitude is |a| by "
        "(7) and max |Z1| of the smallest stable quiet orbit, each averaged over the band by (7).",
        measures=(
            Measure(
                "typical",
                "median relative difference of the two widths over the dampers",
                most=0.25,
                decisive=True,
            ),
            Measure("width", "largest relative difference of the two widths", most=0.25),
            Measure(
                "typical_factor",
                "median factor between mean max |Z1| and mean |a| in the band",
                most=balance_findings.CLOSE,
            ),
            Measure(
                "factor",
                "largest factor between mean max |Z1| and mean |a| in the band",
                most=balance_findings.CLOSE,
            ),
            Measure(
                "least_factor", "smallest factor between mean max |Z1| and mean |a| in the band"
            ),
            Measure(
                "harmonic",
                "largest factor between the mean first harmonic of the orbit and mean |a|",
            ),
            Measure(
                "share",
                "largest difference of max |Z1| and |a| in the band over the free resonance "
                "amplitude",
            ),
            Measure(
                "violent",
                "largest share of random starts, at one W of the band by (7), that lead to a "
                "violent motion",
            ),
        ),
        evidence=accuracy,
        finding=balance_findings.accuracy,
        figures=("figure_05a", "figure_05b", "figure_05c", "figure_08"),
    ),
)
