"""Numbers that test S1 to S6, the places of the paper that may be misprints or omissions."""

import math

import numpy as np

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.datasets import CAPTIONS, RULES, Missing
from impact_damper.data.datasets import flag, oscillator_of
from impact_damper.model.parameters import Oscillator
from impact_damper.theory.design_rule import peak_frequency

STATE = ("displacement", "velocity", "relative_displacement", "relative_velocity")
PRINTED_PEAKS = {0.215: 2.0, 0.15: 2.37, 0.107: 2.8}  # damping h -> Wp printed in the paper
SHALLOW = 0.02  # largest ratio of penetration to clearance at which the expansion of S1 is tested


def misrounding(printed, computed):
    """Return the error of a printed number, divided by half a unit of its last digit."""
    decimals = len(f"{printed:g}".partition(".")[2])
    return abs(printed - computed) * 2 * 10**decimals


def penetration(datasets):
    """Return numbers on misprint S1: the printed expansion of the contact force at small depth."""
    design = reading.get(datasets, "harmonic_balance", CAPTIONS[0])
    mass_ratio, clearance, stiffness = reading.parameters(
        design, "mass_ratio", "clearance", "contact_stiffness"
    )
    depth = (design.relative_amplitude - clearance).values
    difference = design.relative_amplitude - design.amplitude
    force = (mass_ratio / stiffness * design.frequency**2 * difference).values
    impacting = (design.kind == flag("kind", "impacting")).values
    keep = impacting & (depth > 0) & (depth < SHALLOW * clearance) & (force > 0)
    if keep.sum() < 3:
        raise Missing("There are no solutions of (7) with a small penetration")
    depth, force = depth[keep], force[keep]
    corrected = 8 * math.sqrt(2) / (3 * math.pi) * depth**1.5 / math.sqrt(clearance)
    printed = 2 / math.pi * np.sqrt(2 * clearance * depth)
    return {
        "power": np.polyfit(np.log(depth), np.log(force), 1)[0],
        "printed": np.median(printed / force),
        "corrected": np.median(corrected / force),
    }


def captions(datasets):
    """Return numbers on misprint S2: clearances of figure 3, as printed and by rule (19)."""
    numbers = {}
    for panel, *names in zip("ba", CAPTIONS[1:], RULES[1:], strict=True):
        designs = reading.select(datasets, "harmonic_balance", names)
        printed, ruled = (reading.parameter(design, "clearance") for design in designs)
        numbers |= {f"printed_{panel}": printed, f"rule_{panel}": ruled}
        numbers[panel] = misrounding(printed, ruled)
    return numbers


def state_size(datasets):
    """Return numbers on omission S3: how many components a state has. The paper prints three."""
    motion = reading.get(datasets, "motion", "figure_04")
    return {"components": sum(name in motion for name in STATE)}


def design_point(datasets):
    """Return numbers on misprint S4: whether d0 of figure 5 (a) fulfils rm W^2 d0 = 1 at W = 2."""
    design = reading.get(datasets, "harmonic_balance", CAPTIONS[0])
    mass_ratio, clearance = reading.parameters(design, "mass_ratio", "clearance")
    inertia = mass_ratio * PRINTED_PEAKS[0.215] ** 2
    return {
        "rounding": misrounding(clearance, 1 / inertia),
        "printed": clearance,
        "ruled": 1 / inertia,
        "inertia": inertia * clearance,
    }


def peaks(datasets):
    """Return numbers on misprint S5: the peak frequencies that the paper prints."""
    free = {oscillator_of(each): each for each in reading.free(datasets, "branches").values()}
    found = []
    for damping, printed in PRINTED_PEAKS.items():
        if Oscillator(damping) not in free:
            raise Missing(f"There is no dataset of branches without a damper for h = {damping:g}")
        formula = peak_frequency(Oscillator(damping))
        found.append(
            {
                "damping": damping,
                "printed": printed,
                "formula": formula,
                "off": misrounding(printed, formula),
                "end": orbits.resonance_fold(free[Oscillator(damping)])[0],
            }
        )
    return {"peaks": found, "off": max(peak["off"] for peak in found)}


def unprinted(datasets):
    """Return numbers on omission S6: the values we chose for parameters that are not printed."""
    design = reading.get(datasets, "harmonic_balance", "figure_08")
    mass_ratio, clearance = reading.parameters(design, "mass_ratio", "clearance")
    sweeps = [
        sweep
        for sweep in datasets.get("optimum", {}).values()
        if reading.parameter(sweep, "restitution") < 1
    ]
    if not sweeps:
        raise Missing("There is no inelastic sweep of the stage optimum")
    return {
        "clearance": misrounding(clearance, 1 / (mass_ratio * PRINTED_PEAKS[0.107] ** 2)),
        "frequency": max(
            misrounding(reading.parameter(sweep, "frequency"), peak_frequency(oscillator_of(sweep)))
            for sweep in sweeps
        ),
        "inertia": mass_ratio * float(design.peak_frequency) ** 2 * clearance,
        "chosen": clearance,
    }
