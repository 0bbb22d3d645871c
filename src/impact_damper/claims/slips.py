"""Slips of the paper, each taken as the claim that what is printed holds."""

import math

import numpy as np

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Claim, Missing, Number
from impact_damper.data.datasets import flag, oscillator_of
from impact_damper.system.parameters import Oscillator
from impact_damper.theory.design_rule import peak_frequency

STATE = ("displacement", "velocity", "relative_displacement", "relative_velocity")
PRINTED_PEAKS = {0.215: 2.0, 0.15: 2.37, 0.107: 2.8}
PRINTED_STATE = 3
SHALLOW = 0.02


def formula_peak(data):
    """Peak frequency of the oscillator of a dataset, W^2 = wl^2 + 3/(4 h^2 W^2)."""
    return peak_frequency(oscillator_of(data))


def penetration(datasets):
    """Numbers of S1: how B grows with the penetration b - d0 in the solutions of (7)."""
    design = extract.get(datasets, "design", extract.CAPTIONS[0])
    mass_ratio, clearance, stiffness = (
        extract.parameter(design, name) for name in ("mass_ratio", "clearance", "contact_stiffness")
    )
    impacting = design.kind == flag("kind", "impacting")
    depth = (design.relative_amplitude - clearance).where(impacting)
    force = (
        mass_ratio
        / stiffness
        * design.frequency**2
        * (design.relative_amplitude - design.amplitude)
    ).where(impacting)
    keep = ((depth > 0) & (depth < SHALLOW * clearance) & (force > 0)).values
    if keep.sum() < 3:
        raise Missing("There are no solutions of (7) with a small penetration")
    depth, force = depth.values[keep], force.values[keep]
    corrected = 8 * math.sqrt(2) / (3 * math.pi) * depth**1.5 / math.sqrt(clearance)
    printed = 2 / math.pi * np.sqrt(2 * clearance * depth)
    return {
        "power": np.polyfit(np.log(depth), np.log(force), 1)[0],
        "printed": np.median(printed / force),
        "corrected": np.median(corrected / force),
    }


def captions(datasets):
    """Numbers of S2: clearances of the captions over those of (19)."""
    given, ruled = (
        [
            extract.parameter(design, "clearance")
            for design in extract.select(datasets, "design", names[1:])
        ]
        for names in (extract.CAPTIONS, extract.RULES)
    )
    ratios = dict(zip(("b", "a"), np.divide(given, ruled), strict=True))
    return ratios | dict(zip(("rule_b", "rule_a"), ruled, strict=True))


def state_size(datasets):
    """Numbers of S3: components of the state of figure 4."""
    motion = extract.get(datasets, "motion", "figure_04")
    return {
        "components": float(sum(name in motion for name in STATE)),
        "printed": float(PRINTED_STATE),
    }


def design_point(datasets):
    """Numbers of S4: rm W^2 d0 at W = 2 for figure 5 (a)."""
    design = extract.get(datasets, "design", extract.CAPTIONS[0])
    return {
        "inertia": extract.parameter(design, "mass_ratio")
        * 4
        * extract.parameter(design, "clearance")
    }


def peaks(datasets):
    """Numbers of S5: peak frequencies by the formula and by the orbits."""
    numbers = {}
    for free in datasets.get("free_branches", {}).values():
        damping = oscillator_of(free).damping
        if oscillator_of(free) == Oscillator(damping) and damping in PRINTED_PEAKS:
            name = f"{damping:g}"
            numbers[f"formula_{name}"] = formula_peak(free)
            numbers[f"end_{name}"] = exact.resonance_fold(free)[0]
    missing = [value for value in PRINTED_PEAKS if f"formula_{value:g}" not in numbers]
    if missing:
        raise Missing(f"There is no dataset of the stage free_branches with h = {missing[0]:g}")
    return numbers | {
        "worst": max(
            abs(numbers[f"end_{value:g}"] / printed - 1) for value, printed in PRINTED_PEAKS.items()
        )
    }


def unprinted(datasets):
    """Numbers of S6: what is taken where the paper prints nothing."""
    design = extract.get(datasets, "design", "figure_08")
    inertia = extract.parameter(design, "mass_ratio") * float(design.peak_frequency) ** 2
    ratios = [
        extract.parameter(sweep, "frequency") / formula_peak(sweep)
        for sweep in datasets.get("optimum", {}).values()
        if extract.parameter(sweep, "restitution") < 1
    ]
    if not ratios:
        raise Missing("There is no inelastic sweep of the stage optimum")
    return {
        "inertia": inertia * extract.parameter(design, "clearance"),
        "frequency": max(ratios, key=lambda ratio: abs(ratio - 1)),
    }


CLAIMS = (
    Claim(
        "S1",
        "B near b = d0 is (2/pi) sqrt(2 d0 eps), eps = b - d0.",
        "section 2.1, equations (11) and (12)",
        "The power of eps in B in the solutions of (7) with eps below 2 % of d0; expanding (6e) "
        "gives 8 sqrt(2)/(3 pi) eps^(3/2)/sqrt(d0). (13) does not depend on it.",
        (
            Number("power", "power of eps in B", least=0.45, most=0.55, decisive=True),
            Number(
                "printed",
                "median of the printed expression over B",
                least=0.9,
                most=1.1,
                decisive=True,
            ),
            Number("corrected", "median of the expansion of (6e) over B"),
        ),
        penetration,
    ),
    Claim(
        "S2",
        "The captions' d0 = 0.69 for omega_l = 1.5 and 1.2 for omega_l = 1 follow from (19).",
        "section 3, figure 3 (a) and (b)",
        "With the peak frequency of that omega_l.",
        (
            Number(
                "a", "d0 of caption (a) over that of (19)", least=0.95, most=1.05, decisive=True
            ),
            Number(
                "b", "d0 of caption (b) over that of (19)", least=0.95, most=1.05, decisive=True
            ),
            Number("rule_a", "d0 of (19) for (a)"),
            Number("rule_b", "d0 of (19) for (b)"),
        ),
        captions,
    ),
    Claim(
        "S3",
        "The initial conditions of figure 4 are (1, 0.5, 0).",
        "figure 4",
        "A starting state has as many components as the motion.",
        (
            Number("components", "components of the state", most=PRINTED_STATE, decisive=True),
            Number("printed", "numbers printed"),
        ),
        state_size,
    ),
    Claim(
        "S4",
        "(rm, d0) = (0.12, 2) fulfils rm W^2 d0 = 1 at W = 2.",
        "section 3, figure 5 (a)",
        "To 1 %.",
        (Number("inertia", "rm W^2 d0", least=0.99, most=1.01, decisive=True),),
        design_point,
    ),
    Claim(
        "S5",
        "The peak frequencies are 2, 2.37 and 2.8 for h = 0.215, 0.15 and 0.107.",
        "section 3, figures 6 to 8",
        "The fold at which the resonance branch of exact orbits ends, to 1 %; beside it the "
        "formula W^2 = (3/4) a^2, a = 1/(h W).",
        (
            Number(
                "worst",
                "largest relative difference of the folds",
                most=0.01,
                decisive=True,
            ),
            *(
                Number(f"{kind}_{value:g}", f"{words} for h = {value:g}")
                for value in PRINTED_PEAKS
                for kind, words in (("formula", "peak by the formula"), ("end", "fold"))
            ),
        ),
        peaks,
    ),
    Claim(
        "S6",
        "Figure 8 prints no d0, figure 11 neither h nor W: the values taken are the design "
        "of the paper.",
        "figures 8 and 11",
        "Figure 8: d0 by (19) at Wp = 2.8; figure 11: h = 0.215 and W = 2. Judged by the peak "
        "frequency of the formula, to 5 %.",
        (
            Number("inertia", "rm Wp^2 d0 of figure 8", least=0.95, most=1.05, decisive=True),
            Number("frequency", "W/Wp of figure 11", least=0.95, most=1.05, decisive=True),
        ),
        unprinted,
    ),
)
