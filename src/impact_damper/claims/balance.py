"""Claims on harmonic balance: 1, 2 and 3 (sections 2 and 3, figure 3)."""

import numpy as np
import pandas as pd

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Claim, Missing, Number
from impact_damper.claims.suppression import suppression_band
from impact_damper.data.datasets import flag, is_settled

NEAR = 0.1


def small_motion(datasets):
    """Numbers of claim 1: the designs that fulfil (19), and orbits of dampers close to it."""
    designs = extract.select(datasets, "design", extract.RULES)
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
        branches, free = exact.of_curve(datasets, name)
        peak = float(extract.get(datasets, "design", name).peak_frequency)
        small = exact.smallest(exact.quiet(branches, free), peak)["size"]
        orbits.append(small.min() / exact.resonance_fold(free)[1])
    return {
        "vanishing": np.max(vanishing),
        "size": np.nanmax([*sizes, 0.0]),
        "stable": np.mean(np.isfinite(sizes)),
        "orbits": np.mean(np.isfinite(orbits)),
        "orbit_size": np.nanmax([*orbits, 0.0]),
    }


def rigid_against_elastic(datasets):
    """Numbers of claim 2: solutions of (7), roots of (14) and orbits, the quiet ones left out."""
    designs = datasets.get("design", {}).values()
    if not designs:
        raise Missing("There is no dataset of the stage design")
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
                others = np.arange(len(a)) != np.argmin(np.abs(a))
                errors.append(np.max(np.abs(limit - a)[others] / np.abs(a)[others]))
    pairs = pd.concat(
        [
            exact.counterparts(
                extract.get(datasets, "design", name), exact.of_curve(datasets, name)[0]
            )
            for name in extract.ELASTIC
        ]
    )
    others = pairs.difference[~pairs.least]
    near = others[others < NEAR]
    return {
        "alike": np.mean(alike),
        "error": np.max(errors, initial=0.0) if errors else np.nan,
        "orbits": len(near) / len(others) if len(others) else np.nan,
        "orbit_error": near.median(),
    }


def quiet_and_high(datasets):
    """Numbers of claim 3: where stable small and large solutions of (7), and orbits, exist."""
    reach, beside, bands = [], [], []
    for design in extract.select(datasets, "design", (*extract.CAPTIONS, *extract.RULES)):
        peak = float(design.peak_frequency)
        half = exact.HALF * float(design.peak_amplitude)
        frequency = design.frequency.values
        size = np.abs(extract.stable_impacting(design))
        small = (size < half).any("solution").values
        gaps = np.abs(frequency[~small] / peak - 1)
        reach.append(np.min(gaps, initial=np.max(np.abs(frequency / peak - 1))))
        bands.append(int(design.band_status) == flag("band_status", "found"))
        lower = float(design.edge_frequency[0]) if bands[-1] else peak
        below = (frequency > 0.75 * peak) & (frequency < lower)
        level = exact.HALF * extract.free_resonance_balance(design)
        beside.append(np.mean((size > level).any("solution").values[below]))
    return (
        {
            "reach": np.min(reach),
            "bands": np.mean(bands),
            "beside": np.min(beside),
        }
        | _orbits_beside(datasets)
        | _designs(datasets)
    )


def _designs(datasets):
    """Numbers of claim 3 on the true quiet orbits at the designs with a linear spring."""
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
    }


def _orbits_beside(datasets):
    """Numbers of claim 3 on orbits: how far the quiet ones reach, and the high ones."""
    reach, beside, pairs = [], [], []
    for name in extract.ELASTIC:
        branches, free = exact.of_curve(datasets, name)
        design = extract.get(datasets, "design", name)
        peak = float(design.peak_frequency)
        around = [
            min(peak - lower, upper - peak)
            for lower, upper in exact.ranges(exact.quiet(branches, free))
            if lower <= peak <= upper
        ]
        reach.append(max(around, default=0.0) / peak)
        lower, edge = 0.75 * peak, suppression_band(datasets, name).lower
        beside.append(exact.covered(exact.high(branches, free), lower, edge) / (edge - lower))
        pairs.append(exact.high_counterparts(design, branches, free))
    pairs = pd.concat(pairs)
    return {
        "orbit_reach": np.min(reach),
        "orbits_beside": np.min(beside),
        "truly_stable": pairs.stable.mean(),
        "multiplier": pairs.multiplier.median(),
    }


CLAIMS = (
    Claim(
        "1",
        "With rm W^2 d0 = 1 one root of (14) has no amplitude; (7) gives a small amplitude, "
        "stable by appendix A.",
        "section 3",
        "Near the peak frequency, for the designs by (19); and by the exact orbits of the dampers "
        "of figures 5 and 8, whose rm Wp^2 d0 is within 4 % of 1. Small: of period 1 and below "
        "half of the free resonance.",
        (
            Number(
                "vanishing",
                "|rm W^2 d0 - 1| where a root of (14) passes a = 0",
                most=0.005,
                decisive=True,
            ),
            Number(
                "stable",
                "share of designs by (19) with a stable small solution of (7) at Wp",
                least=1,
                decisive=True,
            ),
            Number(
                "size",
                "its largest amplitude over that of the free resonance",
                most=0.05,
                decisive=True,
            ),
            Number(
                "orbits",
                "share of the dampers of figures 5 and 8 with a stable small orbit at Wp",
                least=1,
                decisive=True,
            ),
            Number(
                "orbit_size",
                "its largest max |Z1| over that of the free resonance",
                most=0.05,
                decisive=True,
            ),
        ),
        small_motion,
    ),
    Claim(
        "2",
        "Other impacting solutions of (14) and (7) agree closely.",
        "section 3",
        "All roots of (14) with pushing walls but the smallest, against those of (7) at the same "
        "frequency, wherever both are as many. Beside it the first harmonic of the nearest "
        "symmetric orbit of period 1 with two contacts, stable or not, for the dampers of figures "
        "5 and 8; branches that no stable motion leads to are not known.",
        (
            Number(
                "alike",
                "share of frequencies with as many roots of (14) as of (7)",
                least=0.9,
                decisive=True,
            ),
            Number(
                "error", "largest relative difference of the amplitudes", most=0.05, decisive=True
            ),
            Number("orbits", "share of these solutions of (7) with an orbit within a tenth of a"),
            Number("orbit_error", "median relative difference of these orbits to a"),
        ),
        rigid_against_elastic,
    ),
    Claim(
        "3",
        "Whatever omega_l, a stable low-amplitude solution exists around Wp; a stable "
        "high-amplitude one coexists outside the suppression band.",
        "section 3, figure 3",
        "Low and high: below and above half of the free resonance. Outside the band: from 0.75 Wp "
        "to its lower edge, for above the band the resonance branch has ended. By the stable "
        "solutions of (7), and for omega_l = 0 by the stable orbits that exist, of any period, "
        "with the band by the motions that exist. For all omega_l of figure 3 by the true quiet "
        "orbit at Wp, followed there from heavy damping.",
        (
            Number(
                "reach",
                "least distance from Wp, over Wp, to a frequency without a stable low solution",
                least=0.1,
                decisive=True,
            ),
            Number("bands", "share of designs with a suppression band", least=1, decisive=True),
            Number(
                "beside",
                "least share of frequencies below the band with a stable high solution",
                least=0.5,
                decisive=True,
            ),
            Number(
                "beside",
                "least share of frequencies below the band with a stable high solution",
                least=1,
            ),
            Number(
                "orbit_reach",
                "least distance from Wp, over Wp, to a frequency without a stable low orbit",
                least=0.1,
                decisive=True,
            ),
            Number(
                "orbits_beside",
                "least share of W below the band with a stable high orbit",
                least=0.5,
                decisive=True,
            ),
            Number(
                "orbits_beside",
                "least share of W below the band with a stable high orbit",
                least=1,
            ),
            Number(
                "truly_stable",
                "share of the stable high solutions of (7) whose orbit, symmetric with two "
                "contacts, is stable",
            ),
            Number("multiplier", "median of the largest modulus of a multiplier of these orbits"),
            Number(
                "designs_stable",
                "share of the designs of figure 3, by caption and by (19), whose true quiet orbit "
                "is stable at Wp",
                least=1,
                decisive=True,
            ),
            Number("design_multiplier", "its largest modulus of a multiplier there"),
            Number("design_damping", "damping h above which all of them would be stable"),
            Number(
                "design_settled", "largest share of starts that settle at an unstable one of them"
            ),
        ),
        quiet_and_high,
    ),
)
