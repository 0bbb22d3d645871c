"""Claims on the suppression band: 4, 16 and 17 (sections 3 and 4, figures 3, 5 and 10)."""

import numpy as np

from impact_damper.claims import extract
from impact_damper.claims.claim import Claim, Missing, Number


def growth(widths):
    """Least ratio of a width to the one before."""
    widths = np.asarray(widths, float)
    return float(np.min(widths[1:] / widths[:-1]))


def widening(datasets):
    """Numbers of claim 4."""
    captions = extract.select(datasets, "design", extract.CAPTIONS)
    rules = extract.select(datasets, "design", extract.RULES)
    masses = extract.select(datasets, "design", extract.BY_MASS)
    elastic, inelastic = (
        extract.simulated_band(response, extract.free_of(datasets, response))
        for response in extract.select(
            datasets, "response", (extract.BY_MASS[1], extract.INELASTIC)
        )
    )
    reductions = [float(design.reduction) for design in captions]
    return {
        "linear": growth([design.band_width for design in captions]),
        "linear_rule": growth([design.band_width for design in rules]),
        "mass": growth([design.band_width for design in masses]),
        "restitution": inelastic.least_width / elastic.width,
        "reduction": max(reductions) - min(reductions),
    }


def accuracy(datasets):
    """Numbers of claim 16: harmonic balance against the motions that exist."""
    widths, shares, ratios = [], [], []
    for name, response in datasets.get("response", {}).items():
        if name not in datasets.get("design", {}):
            continue
        design = datasets["design"][name]
        lower, upper = extract.band_edges(design)
        band = extract.simulated_band(response, extract.free_of(datasets, response))
        nearest = np.clip(upper - lower, band.least_width, band.width)
        widths.append(abs(upper - lower - nearest) / nearest)
        simulated = extract.quiet(extract.within(response, lower, upper)).maximum_displacement
        estimate = np.abs(extract.quiet_balance(design)).interp(frequency=simulated.frequency)
        shares.append(float(np.abs(simulated - estimate).max() / design.peak_amplitude))
        ratios.append(float(simulated.mean() / estimate.mean()))
    if not widths:
        raise Missing("There is no curve in both stages design and response")
    return {
        "typical": np.median(widths),
        "width": np.max(widths),
        "share": np.max(shares),
        "ratio": np.max(ratios),
    }


def amplitude_by_mass(datasets):
    """Numbers of claim 17, at the frequencies of the narrowest band."""
    designs = extract.select(datasets, "design", extract.BY_MASS)
    lower, upper = (
        np.max([extract.band_edges(design)[0] for design in designs]),
        np.min([extract.band_edges(design)[1] for design in designs]),
    )
    sizes = [
        extract.quiet(extract.within(response, lower, upper)).maximum_displacement.mean()
        for response in extract.select(datasets, "response", extract.BY_MASS)
    ]
    balance = [
        np.abs(extract.quiet_balance(extract.within(design, lower, upper))).mean()
        for design in designs
    ]
    steps = np.array(sizes[1:]) / np.array(sizes[:-1])
    return {
        "steps": np.max(steps),
        "whole": float(sizes[-1] / sizes[0]),
        "balance": np.max(np.array(balance[1:]) / np.array(balance[:-1])),
    }


CLAIMS = (
    Claim(
        "4",
        "The suppression band widens with omega_l, with rm and with lower e; the reduction "
        "in it barely depends on omega_l.",
        "sections 3 and 4, figures 3, 5 and 10",
        "Width by harmonic balance, for e by the motions that exist. Reduction: 1 - |a|/(free "
        "amplitude) at Wp, with the captions' clearances.",
        (
            Number(
                "linear",
                "least ratio of a width to that at the omega_l before, captions' d0",
                least=1,
                decisive=True,
            ),
            Number("linear_rule", "the same with d0 of (19)", least=1),
            Number(
                "mass", "least ratio of a width to that at the rm before", least=1, decisive=True
            ),
            Number(
                "restitution",
                "width for e = 0.75, its lower bound, over that for e = 1",
                least=1,
                decisive=True,
            ),
            Number("reduction", "spread of the reduction over omega_l", most=0.1),
        ),
        widening,
    ),
    Claim(
        "16",
        "Harmonic balance estimates the amplitude in the suppression band and the band's "
        "width accurately.",
        "section 3, figure 5",
        "Width: of the band without a motion above half of the free resonance, as simulated. "
        "Amplitude: max |Z1| of the quiet motion against |a|, as a share of the free resonance "
        "and as a ratio.",
        (
            Number(
                "typical",
                "median relative difference of the widths over the dampers",
            ),
            Number("width", "largest relative difference of the widths", most=0.25, decisive=True),
            Number(
                "share",
                "largest difference of the amplitudes over that of the free resonance",
                most=0.05,
                decisive=True,
            ),
            Number(
                "ratio",
                "largest ratio of the simulated amplitude to |a|, means over the band",
                most=1.25,
            ),
        ),
        accuracy,
    ),
    Claim(
        "17",
        "The larger rm, the lower the amplitude in the suppression band.",
        "section 3, figure 5",
        "Mean of max |Z1| of the quiet motion over the frequencies that "
        "lie in the suppression bands of all three dampers.",
        (
            Number(
                "whole",
                "amplitude at the largest rm over that at the smallest",
                most=1,
                decisive=True,
            ),
            Number("steps", "largest ratio of an amplitude to that at the rm before", most=1),
            Number("balance", "the same by harmonic balance", most=1),
        ),
        amplitude_by_mass,
    ),
)
