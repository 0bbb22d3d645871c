"""Numbers that test claims 1 to 3, by harmonic balance and exact orbits. Wp: peak frequency."""

import numpy as np
import pandas as pd

from chatterjee1995.reading import bands, orbits
from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading.datasets import Missing
from impact_damper.data.datasets import flag, is_settled

AROUND = 0.1  # W is "around" the peak frequency Wp if |W/Wp - 1| is at most this number
BELOW = 0.75  # lowest W/Wp of the range below the band that is searched for violent motions
ALL_DESIGNS = (*reading.CAPTIONS, *reading.RULES)  # names of all designs of figure 3


def small_motion(datasets):
    """Return numbers that test claim 1: a small stable motion exists if rm W^2 d0 is close to 1."""
    designs = reading.select(datasets, "harmonic_balance", reading.RULES)
    vanishing = []
    for design in designs:
        peak = float(design.peak_frequency)
        roots = reading.within(design, 0.9 * peak, 1.1 * peak).rigid_amplitude
        smallest = roots.isel(root=np.abs(roots).fillna(np.inf).argmin("root"))
        frequency = reading.crossing(smallest.frequency.values, smallest.values, 0.0)
        mass_ratio, clearance = reading.parameters(design, "mass_ratio", "clearance")
        vanishing.append(abs(mass_ratio * frequency**2 * clearance - 1))
    sizes = [float(design.quiet_amplitude / design.peak_amplitude) for design in designs]
    ratios = []
    for name in reading.ELASTIC:
        branches, free = orbits.of_curve(datasets, name)
        peak = float(reading.get(datasets, "harmonic_balance", name).peak_frequency)
        small = orbits.smallest(orbits.quiet(branches, free), peak)["size"]
        ratios.append(small.min() / orbits.resonance_fold(free)[1])
    return {
        "vanishing": np.max(vanishing),
        "size": np.nanmax([*sizes, 0.0]),
        "stable": np.mean(np.isfinite(sizes)),
        "orbits": np.mean(np.isfinite(ratios)),
        "orbit_size": np.nanmax([*ratios, 0.0]),
    }


def rigid_against_elastic(datasets):
    """Return numbers that test claim 2: equations (7) and (14) give the same large amplitudes."""
    designs = reading.damped(datasets, "harmonic_balance").values()
    if not designs:
        raise Missing("There is no dataset of the stage harmonic_balance with a damper")
    errors, alike, pulling = [], [], []
    for design in designs:
        pulling.append((design.rigid_wall == flag("rigid_wall", "pulls")).any("root").values)
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
    return {
        "alike": np.mean(alike),
        "error": np.max(errors) if errors else np.nan,
        "pulling": np.mean(np.concatenate(pulling)),
    }


def quiet_and_high(datasets):
    """Return numbers that test claim 3: motions are quiet near the resonance, violent below it."""
    around, beside, found = [], [], []
    for design in reading.select(datasets, "harmonic_balance", ALL_DESIGNS):
        peak = float(design.peak_frequency)
        half = orbits.HALF * float(design.peak_amplitude)
        size = np.abs(reading.stable_impacting(design))
        near = reading.within(size, (1 - AROUND) * peak, (1 + AROUND) * peak)
        around.append(float((near < half).any("solution").mean()))
        found.append(int(design.band_status) == flag("band_status", "found"))
        lower = float(design.edge_frequency[0]) if found[-1] else peak
        below = (design.frequency > BELOW * peak) & (design.frequency < lower)
        free = design.free_amplitude.max("free_solution").where(design.frequency <= peak)
        beside.append(np.mean((size > orbits.HALF * free).any("solution").values[below.values]))
    return (
        {"around": np.min(around), "bands": np.mean(found), "beside": np.min(beside)}
        | _elastic_orbits(datasets)
        | _design_orbits(datasets)
    )


def _elastic_orbits(datasets):
    around, beside, pairs, single = [], [], [], []
    for name in reading.ELASTIC:
        branches, free = orbits.of_curve(datasets, name)
        design = reading.get(datasets, "harmonic_balance", name)
        peak = float(design.peak_frequency)
        ends = (1 - AROUND) * peak, (1 + AROUND) * peak
        around.append(orbits.covered(orbits.quiet(branches, free), *ends) / (ends[1] - ends[0]))
        ends = BELOW * peak, bands.suppression_band(datasets, name).lower
        beside.append(orbits.covered(orbits.high(branches, free), *ends) / (ends[1] - ends[0]))
        pairs.append(orbits.high_counterparts(design, branches, free))
        response = reading.get(datasets, "response", name)
        in_band = reading.within(response, *reading.band_edges(design))
        shares = reading.share_of_starts(in_band, bands.quiet_motions(in_band, free))
        single.append(float(shares.min()))
    return {
        "orbit_around": np.min(around),
        "orbits_beside": np.min(beside),
        "single": np.min(single),
        "truly_stable": pd.concat(pairs).stable.mean(),
    }


def design_multipliers(datasets):
    """Return the largest |multiplier| of the quiet orbit at each design point of figure 3."""
    followed = reading.select(datasets, "design_orbit", ALL_DESIGNS)
    return np.array([reading.largest_multiplier(reading.design_point(each)) for each in followed])


def _design_orbits(datasets):
    multipliers = design_multipliers(datasets)
    followed = reading.select(datasets, "design_orbit", ALL_DESIGNS)
    unstable = [each for each, size in zip(followed, multipliers, strict=True) if not size < 1]
    settled = [np.mean(is_settled({"outcome": each.design_run_outcome})) for each in unstable]
    sizes = [
        each.design_run_displacement / orbits.resonance_fold(orbits.free_of(datasets, each))[1]
        for each in unstable
    ]
    stiffness = [reading.parameter(each, "linear_frequency") for each in unstable]
    return {
        "designs_stable": np.mean(multipliers < 1),
        "design_multiplier": np.max(multipliers),
        "design_settled": np.max(settled, initial=0.0),
        "unstable_from": min(stiffness, default=np.nan),
        "least_size": min((float(size.min()) for size in sizes), default=np.nan),
        "most_size": max((float(size.max()) for size in sizes), default=np.nan),
    }
