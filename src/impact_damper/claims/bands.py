"""Claims 4, 16 and 17, on the suppression band (sections 3 and 4, figures 3, 5 and 10).

The suppression band is a range of the forcing frequency W, near the peak frequency, without motions
of high amplitude.
"""

import numpy as np

from impact_damper.claims import exact_orbits, extract
from impact_damper.claims.claim import Claim, Measure, Missing
from impact_damper.claims.findings import balance as balance_findings
from impact_damper.claims.suppression import high_motions, suppression_band


def growth(widths):
    """Smallest ratio of a width to the width before it in a sequence."""
    widths = np.asarray(widths, float)
    return float(np.min(widths[1:] / widths[:-1]))


def widening(datasets):
    """Measures of claim 4: the band widens with omega_l, with rm and with lower e."""
    captions = extract.select(datasets, "harmonic_balance", extract.CAPTIONS)
    rules = extract.select(datasets, "harmonic_balance", extract.RULES)
    masses = extract.select(datasets, "harmonic_balance", extract.BY_MASS)
    existing = [suppression_band(datasets, name) for name in extract.BY_MASS]
    steps = [
        wider.least_width / band.width for band, wider in zip(existing, existing[1:], strict=False)
    ]
    inelastic = suppression_band(datasets, extract.INELASTIC)
    reductions = [float(design.reduction) for design in captions]
    return {
        "linear": growth([design.band_width for design in captions]),
        "linear_rule": growth([design.band_width for design in rules]),
        "mass": growth([design.band_width for design in masses]),
        "existing": np.min(steps),
        "restitution": inelastic.least_width / existing[1].width,
        "reduction": max(reductions) - min(reductions),
    }


def accuracy(datasets):
    """Measures of claim 16: harmonic balance gives the band's amplitude and width accurately."""
    widths, shares, ratios, harmonics, violent = [], [], [], [], []
    for name in extract.ELASTIC:
        design = extract.get(datasets, "harmonic_balance", name)
        branches, free = exact_orbits.of_curve(datasets, name)
        lower, upper = extract.band_edges(design)
        band = suppression_band(datasets, name)
        nearest = np.clip(upper - lower, band.least_width, band.width)
        widths.append(abs(upper - lower - nearest) / nearest)
        estimate = np.abs(extract.quiet_balance(extract.within(design, lower, upper)))
        orbits = smallest_quiet_orbits(branches, free, estimate.frequency)
        size, first = orbits["size"].to_numpy(), np.abs(orbits.amplitude.to_numpy())
        shares.append(float(np.max(np.abs(size - estimate.values)) / design.peak_amplitude))
        ratios.append(size.mean() / float(estimate.mean()))
        response = extract.within(extract.get(datasets, "response", name), lower, upper)
        high = high_motions(response, free)
        violent.append(float(extract.share_of_starts(response, high).max()))
        harmonics.append(first.mean() / float(estimate.mean()))
    return {
        "typical": np.median(widths),
        "width": np.max(widths),
        "share": np.max(shares),
        "ratio": np.max(ratios),
        "harmonic": np.max(harmonics),
        "violent": max(violent),
    }


def smallest_quiet_orbits(branches, free, frequency):
    """Return the smallest stable quiet orbit at each frequency; raise Missing if there is none."""
    orbits = exact_orbits.smallest(exact_orbits.quiet(branches, free), frequency)
    missing = np.setdiff1d(frequency, orbits.frequency)
    if len(missing):
        raise Missing(f"There is no stable quiet orbit at W = {missing[0]:.4g}")
    return orbits


def amplitude_by_mass(datasets):
    """Measures of claim 17: the larger rm, the lower the amplitude in the suppression band.

    Amplitudes are averaged over the frequencies that lie in the bands of all dampers.
    """
    designs = extract.select(datasets, "harmonic_balance", extract.BY_MASS)
    lower, upper = (
        np.max([extract.band_edges(design)[0] for design in designs]),
        np.min([extract.band_edges(design)[1] for design in designs]),
    )
    parts = [extract.within(design, lower, upper) for design in designs]
    sizes = [
        smallest_quiet_orbits(*exact_orbits.of_curve(datasets, name), part.frequency)["size"].mean()
        for name, part in zip(extract.BY_MASS, parts, strict=True)
    ]
    balance = [float(np.abs(extract.quiet_balance(part)).mean()) for part in parts]
    steps = np.array(sizes[1:]) / np.array(sizes[:-1])
    return {
        "steps": np.max(steps),
        "whole": float(sizes[-1] / sizes[0]),
        "balance": np.max(np.array(balance[1:]) / np.array(balance[:-1])),
    }


CLAIMS = (
    Claim(
        number="4",
        text="The suppression band widens with omega_l, with rm and with lower e; the reduction "
        "in it barely depends on omega_l.",
        source="sections 3 and 4, figures 3, 5 and 10",
        interpretation="The width is taken by harmonic balance, and for rm and e also by the "
        "motions that exist: from the end of the last violent motion, a stable orbit or chaotic, "
        "to the fold of the free resonance branch. The reduction is 1 - |a|/(free amplitude) at "
        "Wp, with the clearances of the captions.",
        measures=(
            Measure(
                "linear",
                "least ratio of the width to the width at the next smaller omega_l, d0 of the "
                "captions",
                least=1,
                decisive=True,
            ),
            Measure(
                "linear_rule",
                "least ratio of the width to the width at the next smaller omega_l, d0 of (19)",
                least=1,
            ),
            Measure(
                "mass",
                "least ratio of the width to the width at the next smaller rm, harmonic balance",
                least=1,
                decisive=True,
            ),
            Measure(
                "existing",
                "lower bound of the same ratio by the motions that exist",
                least=1,
                decisive=True,
            ),
            Measure(
                "restitution",
                "lower bound of the width for e = 0.75 over the width for e = 1",
                least=1,
                decisive=True,
            ),
            Measure("reduction", "largest minus smallest reduction over omega_l", most=0.1),
        ),
        evidence=widening,
        finding=balance_findings.band_width,
        figures=("figure_10",),
    ),
    Claim(
        number="16",
        text="Harmonic balance estimates the amplitude in the suppression band and the band's "
        "width accurately.",
        source="section 3, figure 5",
        interpretation="The width is compared with the width by the motions that exist, as in "
        "claim 4; the median over the dampers decides, since the end of chaos may depend on a "
        "single start that settles slowly. The amplitude |a| is compared with max |Z1| of the "
        "quiet orbit, relative to the free resonance, which decides, and as a ratio.",
        measures=(
            Measure(
                "typical",
                "median relative difference of the two widths over the dampers",
                most=0.25,
                decisive=True,
            ),
            Measure("width", "largest relative difference of the two widths", most=0.25),
            Measure(
                "share",
                "largest difference of the two amplitudes over the free resonance amplitude",
                most=0.05,
                decisive=True,
            ),
            Measure(
                "ratio",
                "largest ratio of mean max |Z1| to mean |a| in the band",
                most=1.25,
            ),
            Measure(
                "harmonic",
                "largest ratio of the mean first harmonic of the orbit to mean |a| in the band",
            ),
            Measure(
                "violent",
                "largest share of random starts, at one W of the band by harmonic balance, that "
                "lead to a violent motion",
            ),
        ),
        evidence=accuracy,
        finding=balance_findings.accuracy,
        figures=("figure_05a",),
    ),
    Claim(
        number="17",
        text="The larger rm, the lower the amplitude in the suppression band.",
        source="section 3, figure 5",
        interpretation="The amplitude is max |Z1| of the quiet orbit, averaged over the "
        "frequencies that lie in the suppression bands of all three dampers of figure 5.",
        measures=(
            Measure(
                "whole",
                "amplitude at the largest rm over the amplitude at the smallest rm",
                most=1,
                decisive=True,
            ),
            Measure(
                "steps",
                "largest ratio of the amplitude to the amplitude at the next smaller rm",
                most=1,
            ),
            Measure("balance", "the same ratio by harmonic balance", most=1),
        ),
        evidence=amplitude_by_mass,
        finding=balance_findings.amplitude_by_mass,
        figures=("figure_06",),
    ),
)
