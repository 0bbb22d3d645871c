"""Claims on the suppression band: 4, 16 and 17 (sections 3 and 4, figures 3, 5 and 10)."""

import numpy as np

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Claim, Missing, Number
from impact_damper.claims.suppression import suppression_band


def growth(widths):
    """Least ratio of a width to the one before."""
    widths = np.asarray(widths, float)
    return float(np.min(widths[1:] / widths[:-1]))


def widening(datasets):
    """Numbers of claim 4."""
    captions = extract.select(datasets, "design", extract.CAPTIONS)
    rules = extract.select(datasets, "design", extract.RULES)
    masses = extract.select(datasets, "design", extract.BY_MASS)
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
    """Numbers of claim 16: harmonic balance against the motions that exist."""
    widths, shares, ratios, harmonics = [], [], [], []
    for name in extract.ELASTIC:
        design = extract.get(datasets, "design", name)
        branches, free = exact.of_curve(datasets, name)
        lower, upper = extract.band_edges(design)
        band = suppression_band(datasets, name)
        nearest = np.clip(upper - lower, band.least_width, band.width)
        widths.append(abs(upper - lower - nearest) / nearest)
        estimate = np.abs(extract.quiet_balance(extract.within(design, lower, upper)))
        orbits = quiet_orbits(branches, free, estimate.frequency)
        size, first = orbits["size"].to_numpy(), np.abs(orbits.amplitude.to_numpy())
        shares.append(float(np.max(np.abs(size - estimate.values)) / design.peak_amplitude))
        ratios.append(size.mean() / float(estimate.mean()))
        harmonics.append(first.mean() / float(estimate.mean()))
    return {
        "typical": np.median(widths),
        "width": np.max(widths),
        "share": np.max(shares),
        "ratio": np.max(ratios),
        "harmonic": np.max(harmonics),
    }


def quiet_orbits(branches, free, frequency):
    """The smallest stable orbit of period 1 at each frequency, or raise Missing at the first."""
    orbits = exact.smallest(exact.quiet(branches, free), frequency)
    lost = np.setdiff1d(frequency, orbits.frequency)
    if len(lost):
        raise Missing(f"There is no stable quiet orbit at W = {lost[0]:.4g}")
    return orbits


def amplitude_by_mass(datasets):
    """Numbers of claim 17, at the frequencies of the narrowest band."""
    designs = extract.select(datasets, "design", extract.BY_MASS)
    lower, upper = (
        np.max([extract.band_edges(design)[0] for design in designs]),
        np.min([extract.band_edges(design)[1] for design in designs]),
    )
    parts = [extract.within(design, lower, upper) for design in designs]
    sizes = [
        quiet_orbits(*exact.of_curve(datasets, name), part.frequency)["size"].mean()
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
        "4",
        "The suppression band widens with omega_l, with rm and with lower e; the reduction "
        "in it barely depends on omega_l.",
        "sections 3 and 4, figures 3, 5 and 10",
        "Width by harmonic balance, for rm and e also by the motions that exist: from the end of "
        "the last stable high orbit, or the last high chaotic motion, to the fold of the free "
        "resonance branch. Reduction: 1 - |a|/(free amplitude) at Wp, with the captions' "
        "clearances.",
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
                "existing",
                "the same by the motions that exist, its lower bound",
                least=1,
                decisive=True,
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
        "Width: of the band by the motions that exist, from the end of the last stable high "
        "orbit, or the last high chaotic motion, to the fold of the free resonance branch. The "
        "median decides: where chaos ends can hang on one start that is slow to settle. "
        "Amplitude: max |Z1| of the quiet orbit against |a|, as a share of the free resonance "
        "and as a ratio; beside it the first harmonic, which |a| stands for.",
        (
            Number(
                "typical",
                "median relative difference of the widths over the dampers",
                most=0.25,
                decisive=True,
            ),
            Number("width", "largest relative difference of the widths", most=0.25),
            Number(
                "share",
                "largest difference of the amplitudes over that of the free resonance",
                most=0.05,
                decisive=True,
            ),
            Number(
                "ratio",
                "largest ratio of max |Z1| to |a|, means over the band",
                most=1.25,
            ),
            Number("harmonic", "the same for the first harmonic of the orbit"),
        ),
        accuracy,
    ),
    Claim(
        "17",
        "The larger rm, the lower the amplitude in the suppression band.",
        "section 3, figure 5",
        "Mean of max |Z1| of the quiet orbit over the frequencies that "
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
