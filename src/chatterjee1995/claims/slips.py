"""S1 to S6: misprints and omissions of the paper, taken as claims that the print is correct.

A printed value agrees with a computed one if it is the computed one rounded to the printed digits.
Numbers in brackets are equations of the paper: (7) is harmonic balance, and (19) the rule
rm Wp^2 d0 = 1 with the mass ratio rm, the clearance d0 and the peak frequency Wp. A sweep is a
dataset of orbits over d0.

W is the forcing frequency. A stage is a step of the workflow.
"""

import math

import numpy as np

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import (
    GAP,
    NOT_REPRODUCED,
    PART,
    REPRODUCED,
    SLIP,
    Claim,
    Measure,
    Missing,
)
from chatterjee1995.claims.coexistence import quiet_motions
from chatterjee1995.claims.findings import slips as slips_findings
from impact_damper.data.datasets import flag, oscillator_of
from impact_damper.model.parameters import Oscillator
from impact_damper.theory.design_rule import peak_frequency

# STATE: variables of a state of both masses.
# PRINTED_PEAKS: peak frequencies that the paper prints, keyed by the damping h.
# PRINTED_STATE: how many components of the initial state the paper prints.
# RIGHTLY: requirement on `misrounding` for a printed value that is rounded correctly.
# ROUNDING: unit of `misrounding` in the words of a measure.
# SHALLOW: largest ratio of penetration to clearance at which the expansion of S1 is tested.
STATE = ("displacement", "velocity", "relative_displacement", "relative_velocity")
PRINTED_PEAKS = {0.215: 2.0, 0.15: 2.37, 0.107: 2.8}
PRINTED_STATE = 3
RIGHTLY = {"most": 1.0, "decisive": True}
ROUNDING = "in half units of its last digit"
SHALLOW = 0.02


def formula_peak(data):
    """Return the peak frequency Wp of a dataset's oscillator.

    It is the root W of W^2 = wl^2 + 3/(4 h^2 W^2), with the linear frequency wl and the damping h.
    """
    return peak_frequency(oscillator_of(data))


def misrounding(printed, computed):
    """Return the distance of a printed number to a computed one in half units of its last digit.

    It is at most 1 if the computed number, rounded to the printed digits, is the printed one.
    """
    decimals = len(f"{printed:g}".partition(".")[2])
    return abs(printed - computed) * 2 * 10**decimals


def penetration(datasets):
    """Return the measures of S1: expansion of the contact force B for a small penetration b - d0.

    Here b is the amplitude of the relative displacement Z2 in the solutions of (7).
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
    """Return the measures of S2: clearances in the captions of figure 3, compared with (19)."""
    measures = {}
    for panel, caption, rule in zip("ba", extract.CAPTIONS[1:], extract.RULES[1:], strict=True):
        printed, ruled = (
            extract.parameter(extract.get(datasets, "harmonic_balance", name), "clearance")
            for name in (caption, rule)
        )
        measures |= {
            panel: misrounding(printed, ruled),
            f"printed_{panel}": printed,
            f"rule_{panel}": ruled,
        }
    return measures


def state_size(datasets):
    """Return the measures of S3: number of components of the initial state of figure 4."""
    motion = extract.get(datasets, "motion", "figure_04")
    branches, free = exact_orbits.of_curve(datasets, extract.CAPTIONS[0])
    response = extract.get(datasets, "response", extract.CAPTIONS[0])
    frequency = extract.parameter(motion, "frequency")
    at_once = response.sel(frequency=[frequency], method="nearest")
    return {
        "components": float(sum(name in motion for name in STATE)),
        "printed": float(PRINTED_STATE),
        "quiet": float(extract.share_of_starts(at_once, quiet_motions(at_once, free)).item()),
    }


def design_point(datasets):
    """Return the measures of S4: d0 of figure 5 (a), compared with rm W^2 d0 = 1 at W = 2."""
    design = extract.get(datasets, "harmonic_balance", extract.CAPTIONS[0])
    clearance = extract.parameter(design, "clearance")
    inertia = extract.parameter(design, "mass_ratio") * PRINTED_PEAKS[0.215] ** 2
    return {
        "rounding": misrounding(clearance, 1 / inertia),
        "printed": clearance,
        "ruled": 1 / inertia,
        "inertia": inertia * clearance,
    }


def peaks(datasets):
    """Return the measures of S5: peak frequencies by harmonic balance and by exact orbits."""
    numbers = {}
    for free in extract.free(datasets, "branches").values():
        damping = oscillator_of(free).damping
        if oscillator_of(free) == Oscillator(damping) and damping in PRINTED_PEAKS:
            name = f"{damping:g}"
            numbers[f"formula_{name}"] = formula_peak(free)
            numbers[f"printed_{name}"] = PRINTED_PEAKS[damping]
            numbers[f"off_{name}"] = misrounding(PRINTED_PEAKS[damping], formula_peak(free))
            numbers[f"end_{name}"] = exact_orbits.resonance_fold(free)[0]
    missing = [value for value in PRINTED_PEAKS if f"formula_{value:g}" not in numbers]
    if missing:
        raise Missing(f"There is no dataset of branches without a damper for h = {missing[0]:g}")
    return numbers


def unprinted(datasets):
    """Return the measures of S6: the parameters chosen where the paper prints none."""
    design = extract.get(datasets, "harmonic_balance", "figure_08")
    mass_ratio, clearance = (
        extract.parameter(design, name) for name in ("mass_ratio", "clearance")
    )
    sweeps = [
        sweep
        for sweep in datasets.get("optimum", {}).values()
        if extract.parameter(sweep, "restitution") < 1
    ]
    if not sweeps:
        raise Missing("There is no inelastic sweep of the stage optimum")
    return {
        "clearance": misrounding(clearance, 1 / (mass_ratio * PRINTED_PEAKS[0.107] ** 2)),
        "frequency": max(
            misrounding(extract.parameter(sweep, "frequency"), formula_peak(sweep))
            for sweep in sweeps
        ),
        "inertia": mass_ratio * float(design.peak_frequency) ** 2 * clearance,
        "chosen": clearance,
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
        words=SLIP | {NOT_REPRODUCED: "the printed expression is wrong"},
    ),
    Claim(
        number="S2",
        text="The captions' d0 = 0.69 for omega_l = 1.5 and 1.2 for omega_l = 1 follow from (19).",
        source="section 3, figure 3 (a) and (b)",
        interpretation="Rule (19) is taken with rm = 0.12 and with Wp by harmonic balance at the "
        "same omega_l. A printed value is right if it is the computed one rounded to the printed "
        "digits.",
        measures=(
            Measure("a", f"distance of d0 in caption (a) to d0 of (19), {ROUNDING}", **RIGHTLY),
            Measure("b", f"distance of d0 in caption (b) to d0 of (19), {ROUNDING}", **RIGHTLY),
            Measure("printed_a", "d0 of caption (a)"),
            Measure("rule_a", "d0 of (19) for (a)"),
            Measure("printed_b", "d0 of caption (b)"),
            Measure("rule_b", "d0 of (19) for (b)"),
        ),
        evidence=captions,
        finding=slips_findings.captions,
        figures=("figure_03a", "figure_03b"),
        words=SLIP | {NOT_REPRODUCED: "the printed values do not follow"},
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
            Measure(
                "quiet",
                "share of random starts at the W of figure 4 that lead to the quiet motion",
            ),
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
        interpretation="The paper takes W = 2 as the design frequency for h = 0.215. The printed "
        "d0 is right if it is the d0 for which the product is 1, rounded to the printed digits.",
        measures=(
            Measure(
                "rounding",
                f"distance of the printed d0 to the d0 for which rm W^2 d0 = 1, {ROUNDING}",
                **RIGHTLY,
            ),
            Measure("ruled", "d0 for which rm W^2 d0 = 1"),
            Measure("inertia", "rm W^2 d0"),
        ),
        evidence=design_point,
        finding=slips_findings.design_point,
        figures=("figure_06",),
        words=SLIP | {REPRODUCED: "the printed value is a right rounding"},
    ),
    Claim(
        number="S5",
        text="The peak frequencies are 2, 2.37 and 2.8 for h = 0.215, 0.15 and 0.107.",
        source="section 3, figures 6 to 8",
        interpretation="The peak frequency is taken where the free resonance by harmonic balance "
        "crosses its backbone, W^2 = (3/4) a^2 with a = 1/(h W), close to its end. A printed "
        "value is right if it is this one rounded to the printed digits. The end of the resonance "
        "branch of exact orbits, its fold, is given too.",
        measures=tuple(
            Measure(f"{kind}_{value:g}", f"{words} for h = {value:g}{unit}", **bounds)
            for value in PRINTED_PEAKS
            for kind, words, unit, bounds in (
                (
                    "off",
                    "distance of the printed peak to the computed one",
                    f", {ROUNDING}",
                    RIGHTLY,
                ),
                ("formula", "peak by harmonic balance", "", {}),
                ("end", "fold of the exact orbits", "", {}),
            )
        ),
        evidence=peaks,
        finding=slips_findings.peaks,
        figures=("figure_07",),
        words=SLIP,
    ),
    Claim(
        number="S6",
        text="Figure 8 prints no d0, figure 11 no W: the values chosen agree with the design of "
        "the paper.",
        source="figures 8 and 11",
        interpretation="Figure 8 is computed with d0 by (19) at the printed Wp = 2.8, figure 11 "
        "with W = 2; its h = 0.215 is assumed, as in figure 6, and not judged. A value chosen is "
        "right if it is the computed one rounded to "
        "its digits: for d0 that of (19) at the printed Wp, for W the peak by harmonic balance.",
        measures=(
            Measure(
                "clearance",
                f"distance of d0 of figure 8 to d0 of (19) at W = 2.8, {ROUNDING}",
                **RIGHTLY,
            ),
            Measure("frequency", f"distance of W of figure 11 to Wp, {ROUNDING}", **RIGHTLY),
            Measure("chosen", "d0 of figure 8"),
            Measure("inertia", "rm Wp^2 d0 of figure 8 at the Wp by harmonic balance"),
        ),
        evidence=unprinted,
        finding=slips_findings.unprinted,
        figures=("figure_08", "figure_11"),
        words=GAP,
    ),
)
