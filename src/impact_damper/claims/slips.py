"""Slips S1 to S6: misprints and gaps of the paper, taken as claims that the print is correct."""

import math

import numpy as np

from impact_damper.claims import exact_orbits, extract
from impact_damper.claims.claim import GAP, PART, SLIP, Claim, Measure, Missing
from impact_damper.claims.findings import slips as slips_findings
from impact_damper.data.datasets import flag, oscillator_of
from impact_damper.system.parameters import Oscillator
from impact_damper.theory.design_rule import peak_frequency

STATE = ("displacement", "velocity", "relative_displacement", "relative_velocity")
PRINTED_PEAKS = {0.215: 2.0, 0.15: 2.37, 0.107: 2.8}
PRINTED_STATE = 3
SHALLOW = 0.02  # largest ratio of penetration to clearance at which the expansion is tested


def formula_peak(data):
    """Peak frequency Wp of a dataset's oscillator, the root W of W^2 = wl^2 + 3/(4 h^2 W^2)."""
    return peak_frequency(oscillator_of(data))


def penetration(datasets):
    """Measures of S1: expansion of the contact force B for a small penetration b - d0.

    Here b is the amplitude of Z2 in the solutions of (7), and d0 the clearance.
    """
    design = extract.get(datasets, "harmonic_balance", extract.CAPTIONS[0])
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
    """Measures of S2: clearances in the captions of figure 3, divided by the clearances of (19)."""
    printed, ruled = (
        [
            extract.parameter(design, "clearance")
            for design in extract.select(datasets, "harmonic_balance", names[1:])
        ]
        for names in (extract.CAPTIONS, extract.RULES)
    )
    ratios = dict(zip(("b", "a"), np.divide(printed, ruled), strict=True))
    return ratios | dict(zip(("rule_b", "rule_a"), ruled, strict=True))


def state_size(datasets):
    """Measures of S3: number of components of the initial state of figure 4."""
    motion = extract.get(datasets, "motion", "figure_04")
    return {
        "components": float(sum(name in motion for name in STATE)),
        "printed": float(PRINTED_STATE),
    }


def design_point(datasets):
    """Measures of S4: rm W^2 d0 at W = 2 for figure 5 (a)."""
    design = extract.get(datasets, "harmonic_balance", extract.CAPTIONS[0])
    return {
        "inertia": extract.parameter(design, "mass_ratio")
        * 4
        * extract.parameter(design, "clearance")
    }


def peaks(datasets):
    """Measures of S5: peak frequencies by the formula and by exact orbits."""
    numbers = {}
    for free in extract.free(datasets, "branches").values():
        damping = oscillator_of(free).damping
        if oscillator_of(free) == Oscillator(damping) and damping in PRINTED_PEAKS:
            name = f"{damping:g}"
            numbers[f"formula_{name}"] = formula_peak(free)
            numbers[f"end_{name}"] = exact_orbits.resonance_fold(free)[0]
    missing = [value for value in PRINTED_PEAKS if f"formula_{value:g}" not in numbers]
    if missing:
        raise Missing(f"There is no dataset of branches without a damper for h = {missing[0]:g}")
    return numbers | {
        "worst": max(
            abs(numbers[f"end_{value:g}"] / printed - 1) for value, printed in PRINTED_PEAKS.items()
        )
    }


def unprinted(datasets):
    """Measures of S6: the parameters chosen where the paper prints none."""
    design = extract.get(datasets, "harmonic_balance", "figure_08")
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
        number="S1",
        text="B near b = d0 is (2/pi) sqrt(2 d0 eps), eps = b - d0.",
        source="section 2.1, equations (11) and (12)",
        interpretation="B is computed from the solutions of (7) with eps below 2 % of d0. "
        "Expanding (6e) gives 8 sqrt(2)/(3 pi) eps^(3/2)/sqrt(d0). Equation (13) does not depend "
        "on this expansion.",
        measures=(
            Measure("power", "power of eps in B", least=0.45, most=0.55, decisive=True),
            Measure(
                "printed",
                "median of the printed expression over B",
                least=0.9,
                most=1.1,
                decisive=True,
            ),
            Measure("corrected", "median of the expansion of (6e) over B"),
        ),
        evidence=penetration,
        finding=slips_findings.penetration,
        words=SLIP,
    ),
    Claim(
        number="S2",
        text="The captions' d0 = 0.69 for omega_l = 1.5 and 1.2 for omega_l = 1 follow from (19).",
        source="section 3, figure 3 (a) and (b)",
        interpretation="Rule (19) is taken with the peak frequency of the same omega_l, and must "
        "agree within 5 %.",
        measures=(
            Measure("a", "d0 of caption (a) over d0 of (19)", least=0.95, most=1.05, decisive=True),
            Measure("b", "d0 of caption (b) over d0 of (19)", least=0.95, most=1.05, decisive=True),
            Measure("rule_a", "d0 of (19) for (a)"),
            Measure("rule_b", "d0 of (19) for (b)"),
        ),
        evidence=captions,
        finding=slips_findings.captions,
        figures=("figure_03a",),
        words=SLIP,
    ),
    Claim(
        number="S3",
        text="The initial conditions of figure 4 are (1, 0.5, 0).",
        source="figure 4",
        interpretation="Initial conditions must have as many numbers as the state.",
        measures=(
            Measure(
                "components", "number of components of the state", most=PRINTED_STATE, decisive=True
            ),
            Measure("printed", "number of values printed"),
        ),
        evidence=state_size,
        finding=slips_findings.state_size,
        figures=("figure_04",),
        words=PART,
    ),
    Claim(
        number="S4",
        text="(rm, d0) = (0.12, 2) fulfils rm W^2 d0 = 1 at W = 2.",
        source="section 3, figure 5 (a)",
        interpretation="The product must be 1 within 1 %.",
        measures=(Measure("inertia", "rm W^2 d0", least=0.99, most=1.01, decisive=True),),
        evidence=design_point,
        finding=slips_findings.design_point,
        figures=("figure_06",),
        words=SLIP,
    ),
    Claim(
        number="S5",
        text="The peak frequencies are 2, 2.37 and 2.8 for h = 0.215, 0.15 and 0.107.",
        source="section 3, figures 6 to 8",
        interpretation="The peak frequency is where the fold ends the resonance branch of exact "
        "orbits; the printed values must agree within 1 %. The formula W^2 = (3/4) a^2, a = 1/(h "
        "W), is given too.",
        measures=(
            Measure(
                "worst",
                "largest relative difference of a fold to the printed frequency",
                most=0.01,
                decisive=True,
            ),
            *(
                Measure(f"{kind}_{value:g}", f"{words} for h = {value:g}")
                for value in PRINTED_PEAKS
                for kind, words in (("formula", "peak by the formula"), ("end", "fold"))
            ),
        ),
        evidence=peaks,
        finding=slips_findings.peaks,
        figures=("figure_07",),
        words=SLIP,
    ),
    Claim(
        number="S6",
        text="Figure 8 prints no d0, figure 11 neither h nor W: the values chosen agree with the "
        "design of the paper.",
        source="figures 8 and 11",
        interpretation="Figure 8 is computed with d0 by (19) at Wp = 2.8, figure 11 with h = "
        "0.215 and W = 2. Both must agree with the peak frequency by the formula within 5 %.",
        measures=(
            Measure("inertia", "rm Wp^2 d0 of figure 8", least=0.95, most=1.05, decisive=True),
            Measure("frequency", "W/Wp of figure 11", least=0.95, most=1.05, decisive=True),
        ),
        evidence=unprinted,
        finding=slips_findings.unprinted,
        figures=("figure_08",),
        words=GAP,
    ),
)
