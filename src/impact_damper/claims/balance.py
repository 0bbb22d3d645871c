"""Claims 1, 2 and 3, on solutions of harmonic balance (sections 2 and 3, figure 3).

Equation (7) is harmonic balance with elastic contacts, equation (14) its limit of rigid walls; a is
the amplitude of the primary mass. W is the forcing frequency, Wp the peak frequency.
"""

import numpy as np
import pandas as pd

from impact_damper.claims import exact_orbits, extract
from impact_damper.claims.claim import Claim, Measure, Missing
from impact_damper.claims.findings import balance as balance_findings
from impact_damper.claims.suppression import suppression_band
from impact_damper.data.datasets import flag, is_settled

NEAR = 0.1  # largest relative difference of an orbit that agrees with a solution of (7)


def small_motion(datasets):
    """Measures of claim 1: at rm W^2 d0 = 1 equations (14) and (7) have a small stable solution.

    They are computed from harmonic balance for dampers whose clearance follows rule (19), and from
    the exact orbits for the dampers of figures 5 and 8.
    """
    designs = extract.select(datasets, "harmonic_balance", extract.RULES)
    vanishing = []
    for design in designs:
        peak = float(design.peak_frequency)
        roots = extract.within(design, 0.9 * peak, 1.1 * peak).rigid_amplitude
        smallest = roots.isel(root=np.abs(roots).fillna(np.inf).argmin("root"))
        frequency = extract.crossing(smallest.frequency.values, smallest.values, 0.0)
        inertia = extract.parameter(design, "mass_ratio") * frequency**2
        vanishing.append(abs(inertia * extract.parameter(design, "clearance") - 1))
    sizes = [float(design.quiet_amplitude / design.peak_amplitude) for design in designs]
    orbits = []
    for name in extract.ELASTIC:
        branches, free = exact_orbits.of_curve(datasets, name)
        peak = float(extract.get(datasets, "harmonic_balance", name).peak_frequency)
        small = exact_orbits.smallest(exact_orbits.quiet(branches, free), peak)["size"]
        orbits.append(small.min() / exact_orbits.resonance_fold(free)[1])
    return {
        "vanishing": np.max(vanishing),
        "size": np.nanmax([*sizes, 0.0]),
        "stable": np.mean(np.isfinite(sizes)),
        "orbits": np.mean(np.isfinite(orbits)),
        "orbit_size": np.nanmax([*orbits, 0.0]),
        "designs": len(designs),
        "dampers": len(orbits),
    }


def rigid_against_elastic(datasets):
    """Measures of claim 2: the larger solutions of (14) and (7) agree.

    The smallest solution at each frequency is left out. Exact orbits are compared with (7) as well.
    """
    designs = extract.damped(datasets, "harmonic_balance").values()
    if not designs:
        raise Missing("There is no dataset of the stage harmonic_balance with a damper")
    errors, alike = [], []
    for design in designs:
        impacting = design.kind == flag("kind", "impacting")
        pushing = design.rigid_wall == flag("rigid_wall", "pushes")
        elastic = np.sort(design.amplitude.where(impacting).values)
        rigid = np.sort(design.rigid_amplitude.where(pushing).values)
        for a, limit in zip(elastic, rigid, strict=True):
            a, limit = a[np.isfinite(a)], limit[np.isfinite(limit)]
            alike.append(len(a) == len(limit))
            if alike[-1] and len(a) > 1:
                larger = np.arange(len(a)) != np.argmin(np.abs(a))
                errors.append(np.max(np.abs(limit - a)[larger] / np.abs(a)[larger]))
    pairs = pd.concat(
        [
            exact_orbits.counterparts(
                extract.get(datasets, "harmonic_balance", name),
                exact_orbits.of_curve(datasets, name)[0],
            )
            for name in extract.ELASTIC
        ]
    )
    differences = pairs.difference[~pairs.least]
    near = differences[differences < NEAR]
    return {
        "alike": np.mean(alike),
        "error": np.max(errors, initial=0.0) if errors else np.nan,
        "orbits": len(near) / len(differences) if len(differences) else np.nan,
        "orbit_error": near.median(),
    }


def quiet_and_high(datasets):
    """Measures of claim 3: small stable motions around Wp, large ones outside the suppression band.

    They are computed from the solutions of (7) for all omega_l, and from exact orbits.
    """
    reach, beside, bands = [], [], []
    for design in extract.select(datasets, "harmonic_balance", (*extract.CAPTIONS, *extract.RULES)):
        peak = float(design.peak_frequency)
        half = exact_orbits.HALF * float(design.peak_amplitude)
        frequency = design.frequency.values
        size = np.abs(extract.stable_impacting(design))
        small = (size < half).any("solution").values
        gaps = np.abs(frequency[~small] / peak - 1)
        reach.append(np.min(gaps, initial=np.max(np.abs(frequency / peak - 1))))
        bands.append(int(design.band_status) == flag("band_status", "found"))
        lower = float(design.edge_frequency[0]) if bands[-1] else peak
        below = (frequency > 0.75 * peak) & (frequency < lower)
        level = exact_orbits.HALF * extract.free_resonance_balance(design)
        beside.append(np.mean((size > level).any("solution").values[below]))
    return (
        {
            "reach": np.min(reach),
            "bands": np.mean(bands),
            "beside": np.min(beside),
        }
        | _quiet_and_high_orbits(datasets)
        | _design_orbits(datasets)
    )


def _design_orbits(datasets):
    """Measures of claim 3 from the exact quiet orbits of figure 3 at the design point W = Wp."""
    names = (*extract.CAPTIONS[1:], *extract.RULES)
    orbits = extract.select(datasets, "design_orbit", names)
    multipliers = [extract.largest_multiplier(extract.design_point(orbit)) for orbit in orbits]
    unstable = [orbit for orbit, size in zip(orbits, multipliers, strict=True) if not size < 1]
    settled = [np.mean(is_settled({"outcome": orbit.design_run_outcome})) for orbit in unstable]
    return {
        "designs_stable": np.mean(np.array(multipliers) < 1),
        "design_multiplier": np.max(multipliers),
        "design_damping": max(map(extract.stable_from, orbits)),
        "design_settled": np.max(settled, initial=0.0),
        "designs": len(orbits),
    }


def _quiet_and_high_orbits(datasets):
    """Measures of claim 3 for omega_l = 0, from the ranges of W of quiet and violent orbits."""
    reach, beside, pairs = [], [], []
    for name in extract.ELASTIC:
        branches, free = exact_orbits.of_curve(datasets, name)
        design = extract.get(datasets, "harmonic_balance", name)
        peak = float(design.peak_frequency)
        around = [
            min(peak - lower, upper - peak)
            for lower, upper in exact_orbits.ranges(exact_orbits.quiet(branches, free))
            if lower <= peak <= upper
        ]
        reach.append(max(around, default=0.0) / peak)
        lower, edge = 0.75 * peak, suppression_band(datasets, name).lower
        beside.append(
            exact_orbits.covered(exact_orbits.high(branches, free), lower, edge) / (edge - lower)
        )
        pairs.append(exact_orbits.high_counterparts(design, branches, free))
    pairs = pd.concat(pairs)
    return {
        "orbit_reach": np.min(reach),
        "orbits_beside": np.min(beside),
        "truly_stable": pairs.stable.mean(),
        "multiplier": pairs.multiplier.median(),
    }


CLAIMS = (
    Claim(
        number="1",
        text="With rm W^2 d0 = 1 one root of (14) has zero amplitude; (7) gives a small amplitude, "
        "stable by appendix A.",
        source="section 3",
        interpretation="Near the peak frequency, for the designs with the clearance of (19), and "
        "for the exact orbits of the dampers of figures 5 and 8, whose rm Wp^2 d0 is within 4 % "
        "of 1. A small motion is a quiet one, of period 1 and below half of the free resonance.",
        measures=(
            Measure(
                "vanishing",
                "|rm W^2 d0 - 1| at the frequency where a root of (14) has a = 0",
                most=0.005,
                decisive=True,
            ),
            Measure(
                "stable",
                "share of designs by (19) with a stable small solution of (7) at Wp",
                least=1,
                decisive=True,
            ),
            Measure(
                "size",
                "largest ratio of the amplitude of this solution to the free resonance amplitude",
                most=0.05,
                decisive=True,
            ),
            Measure(
                "orbits",
                "share of the dampers of figures 5 and 8 with a stable small orbit at Wp",
                least=1,
                decisive=True,
            ),
            Measure(
                "orbit_size",
                "largest ratio of max |Z1| of this orbit to the free resonance",
                most=0.05,
                decisive=True,
            ),
        ),
        evidence=small_motion,
        finding=balance_findings.small_motion,
        figures=("figure_03c",),
    ),
    Claim(
        number="2",
        text="Other impacting solutions of (14) and (7) agree closely.",
        source="section 3",
        interpretation="All roots of (14) with walls that push, except the smallest, are compared "
        "with the solutions of (7) at the same frequency, where both have equally many. In "
        "addition the larger solutions of (7) are compared with the first harmonic of the nearest "
        "exact orbit with two symmetric contacts, stable or not, for the dampers of figures 5 and "
        "8; branches without any stable part are not known.",
        measures=(
            Measure(
                "alike",
                "share of frequencies at which (14) and (7) have the same number of solutions",
                least=0.9,
                decisive=True,
            ),
            Measure(
                "error", "largest relative difference of the amplitudes", most=0.05, decisive=True
            ),
            Measure(
                "orbits", "share of the larger solutions of (7) with an orbit within 10 % of a"
            ),
            Measure(
                "orbit_error",
                "median relative difference between the first harmonic of these orbits and a",
            ),
        ),
        evidence=rigid_against_elastic,
        finding=balance_findings.rigid_against_elastic,
    ),
    Claim(
        number="3",
        text="Whatever omega_l, a stable low-amplitude solution exists around Wp; a stable "
        "high-amplitude one coexists outside the suppression band.",
        source="section 3, figure 3",
        interpretation="Low and high amplitudes are read as quiet and violent motions, below and "
        "above half of the free resonance. Outside the band means from 0.75 Wp to the lower edge "
        "of the band, since above the band the resonance branch has ended. Judged by the stable "
        "solutions of (7), for omega_l = 0 also by the stable exact orbits of any period, and for "
        "the designs of figure 3 by the exact quiet orbit at Wp, followed from heavy damping.",
        measures=(
            Measure(
                "reach",
                "least distance from Wp, over Wp, to a frequency without a stable quiet solution",
                least=0.1,
                decisive=True,
            ),
            Measure("bands", "share of designs with a suppression band", least=1, decisive=True),
            Measure(
                "beside",
                "least share of frequencies below the band with a stable violent solution",
                least=0.5,
                decisive=True,
            ),
            Measure(
                "beside",
                "least share of frequencies below the band with a stable violent solution",
                least=1,
            ),
            Measure(
                "orbit_reach",
                "least distance from Wp, over Wp, to a frequency without a stable quiet orbit",
                least=0.1,
                decisive=True,
            ),
            Measure(
                "orbits_beside",
                "least share of the range below the band with a stable violent orbit",
                least=0.5,
                decisive=True,
            ),
            Measure(
                "orbits_beside",
                "least share of the range below the band with a stable violent orbit",
                least=1,
            ),
            Measure(
                "truly_stable",
                "share of the stable violent solutions of (7) whose nearest symmetric orbit with "
                "two contacts is stable",
            ),
            Measure(
                "multiplier", "median of the largest Floquet multiplier modulus of these orbits"
            ),
            Measure(
                "designs_stable",
                "share of the designs of figure 3, by caption and by (19), with a stable exact "
                "quiet orbit at Wp",
                least=1,
                decisive=True,
            ),
            Measure(
                "design_multiplier", "largest Floquet multiplier modulus of these quiet orbits"
            ),
            Measure("design_damping", "damping h above which all these quiet orbits are stable"),
            Measure(
                "design_settled",
                "largest share of random starts that settle at a design with an unstable quiet "
                "orbit",
            ),
        ),
        evidence=quiet_and_high,
        finding=balance_findings.quiet_and_high,
        figures=("figure_03b",),
    ),
)
