"""Claim 17, on the amplitude in the suppression band over the mass ratio (section 3, figure 5).

The suppression band is the range of the forcing frequency W around the peak in which no motion with
the damper is violent (large). rm is the mass ratio and d0 the clearance. The quiet orbit is the
small periodic motion for which a damper is designed. Numbers in brackets are equations of the
paper.
"""

import numpy as np

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.bands import smallest_quiet_orbits
from chatterjee1995.claims.claim import Claim, Measure, Missing
from chatterjee1995.claims.findings import balance as balance_findings
from impact_damper.data.datasets import oscillator_of


def amplitude_by_mass(datasets):
    """Return the measures of claim 17: the larger rm, the lower the amplitude in the band.

    For the dampers of figure 5 amplitudes are averaged over the frequencies that lie in the bands
    of all three. For dampers with rm W^2 d0 = 1 the amplitudes come from the clearance sweeps of
    figure 6. A sweep computes the quiet orbit over d0 at the design frequency W of the paper.
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
    masses = [extract.parameter(design, "mass_ratio") for design in designs]
    sweeps = elastic_sweeps(datasets, designs[0])
    frequency = extract.parameter(sweeps[0], "frequency")
    ruled = [
        float(sweep.quiet_displacement.interp(clearance=sweep.rule_clearance)) for sweep in sweeps
    ]
    products = [
        mass * frequency**2 * extract.parameter(design, "clearance")
        for mass, design in zip(masses, designs, strict=True)
    ]
    return {
        "whole": float(sizes[-1] / sizes[0]),
        "rule": ruled[-1] / ruled[0],
        "steps": np.max(steps),
        "balance": np.max(np.array(balance[1:]) / np.array(balance[:-1])),
        "frequency": frequency,
        "lightest": masses[0],
        "heaviest": masses[-1],
        "rule_lightest": extract.parameter(sweeps[0], "mass_ratio"),
        "rule_heaviest": extract.parameter(sweeps[-1], "mass_ratio"),
    } | {f"product_{k}": product for k, product in zip("abc", products, strict=True)}


def elastic_sweeps(datasets, design):
    """Return the clearance sweeps with elastic contact for a design's oscillator, sorted by rm.

    The stage `optimum` computes them.
    """
    found = [
        sweep
        for sweep in datasets.get("optimum", {}).values()
        if oscillator_of(sweep) == oscillator_of(design)
        and extract.parameter(sweep, "restitution") == 1
    ]
    if len(found) < 2:
        raise Missing("There are no two elastic sweeps of the stage optimum for figure 5")
    return sorted(found, key=lambda sweep: extract.parameter(sweep, "mass_ratio"))


CLAIMS = (
    Claim(
        number="17",
        text="The larger rm, the lower the amplitude in the suppression band.",
        source="section 3, figure 5",
        interpretation="The amplitude is max |Z1| of the quiet orbit. The paper compares dampers "
        "that fulfil (19). Two comparisons decide: the dampers of figure 5 as printed, averaged "
        "over the W in the bands by (7) of all three; and the dampers of figure 6 that fulfil (19) "
        "at the design frequency of the paper, W = 2, at this W. Lower means not higher; for full "
        "agreement, lower by at least 5 %, since less can hardly be read from a figure.",
        measures=(
            Measure(
                "whole",
                "amplitude at the largest rm over the amplitude at the smallest rm, figure 5",
                most=1,
                decisive=True,
            ),
            Measure(
                "rule",
                "amplitude at the largest rm over the amplitude at the smallest rm, d0 by (19)",
                most=1,
                decisive=True,
            ),
            Measure(
                "whole",
                "amplitude at the largest rm over the amplitude at the smallest rm, figure 5",
                most=0.95,
            ),
            Measure(
                "rule",
                "amplitude at the largest rm over the amplitude at the smallest rm, d0 by (19)",
                most=0.95,
            ),
            Measure(
                "steps",
                "largest ratio of the amplitude to the amplitude at the next smaller rm, figure 5",
                most=1,
            ),
            Measure("balance", "the same ratio by (7)", most=1),
            Measure("product_a", "rm W^2 d0 of figure 5 (a) at the design frequency"),
            Measure("product_b", "rm W^2 d0 of figure 5 (b) at the design frequency"),
            Measure("product_c", "rm W^2 d0 of figure 5 (c) at the design frequency"),
        ),
        evidence=amplitude_by_mass,
        finding=balance_findings.amplitude_by_mass,
        figures=("figure_06",),
    ),
)
