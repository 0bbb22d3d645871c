"""Claim 3, on the quiet and the violent motion that coexist (section 3, figure 3).

A motion is violent ("high" in names of functions) if its largest displacement exceeds half of that
on the resonance branch without the damper, at the same forcing frequency W. A quiet motion has the
period of the forcing and is not violent. The suppression band is the range of W around the peak
frequency Wp in which no motion with the damper is violent. Equation (7) of the paper is harmonic
balance with elastic contacts, and (19) its rule for the clearance d0. omega_l is the linear
frequency.
"""

import numpy as np
import pandas as pd

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import Claim, Measure
from chatterjee1995.claims.findings import balance as balance_findings
from chatterjee1995.claims.suppression import high_motions, suppression_band
from impact_damper.data.datasets import flag, is_settled

AROUND = 0.1  # a frequency is around Wp if |W/Wp - 1| is at most this
BELOW = 0.75  # least W/Wp at which violent motions below the band are looked for

# The designs of figure 3, with d0 from the captions and from (19).
ALL_DESIGNS = (*extract.CAPTIONS, *extract.RULES)


def quiet_and_high(datasets):
    """Return the measures of claim 3: quiet motions around Wp, violent ones outside the band.

    They are computed from the solutions of (7) for all omega_l, and from exact periodic orbits.
    """
    around, beside, bands = [], [], []
    designs = extract.select(datasets, "harmonic_balance", (*extract.CAPTIONS, *extract.RULES))
    for design in designs:
        peak = float(design.peak_frequency)
        half = exact_orbits.HALF * float(design.peak_amplitude)
        size = np.abs(extract.stable_impacting(design))
        near = extract.within(size, (1 - AROUND) * peak, (1 + AROUND) * peak)
        around.append(float((near < half).any("solution").mean()))
        bands.append(int(design.band_status) == flag("band_status", "found"))
        lower = float(design.edge_frequency[0]) if bands[-1] else peak
        below = (design.frequency > BELOW * peak) & (design.frequency < lower)
        level = exact_orbits.HALF * extract.free_resonance_balance(design)
        beside.append(np.mean((size > level).any("solution").values[below.values]))
    return (
        {
            "around": np.min(around),
            "bands": np.mean(bands),
            "beside": np.min(beside),
            "designs": len(designs),
        }
        | _quiet_and_high_orbits(datasets)
        | _design_orbits(datasets)
    )


def design_multipliers(datasets):
    """Return the largest Floquet multiplier modulus of each quiet orbit of figure 3 at W = Wp.

    The orbits are exact periodic orbits, which are stable if this modulus is below 1.
    """
    orbits = extract.select(datasets, "design_orbit", ALL_DESIGNS)
    return np.array([extract.largest_multiplier(extract.design_point(orbit)) for orbit in orbits])


def _design_orbits(datasets):
    """Return the measures of claim 3 from the exact quiet orbits of figure 3 at W = Wp."""
    orbits = extract.select(datasets, "design_orbit", ALL_DESIGNS)
    multipliers = design_multipliers(datasets)
    unstable = [orbit for orbit, size in zip(orbits, multipliers, strict=True) if not size < 1]
    settled = [np.mean(is_settled({"outcome": orbit.design_run_outcome})) for orbit in unstable]
    sizes = [
        orbit.design_run_displacement
        / exact_orbits.resonance_fold(exact_orbits.free_of(datasets, orbit))[1]
        for orbit in unstable
    ]
    return {
        "designs_stable": np.mean(multipliers < 1),
        "design_multiplier": np.max(multipliers),
        "design_damping": max(map(extract.stable_from, orbits)),
        "design_settled": np.max(settled, initial=0.0),
        "unstable_from": min(
            (extract.parameter(orbit, "linear_frequency") for orbit in unstable), default=np.nan
        ),
        "least_size": min((float(size.min()) for size in sizes), default=np.nan),
        "most_size": max((float(size.max()) for size in sizes), default=np.nan),
    }


def _quiet_and_high_orbits(datasets):
    """Return the measures of claim 3 for omega_l = 0.

    They are computed from the ranges of W in which quiet and violent orbits exist.
    """
    around, beside, pairs, single = [], [], [], []
    for name in extract.ELASTIC:
        branches, free = exact_orbits.of_curve(datasets, name)
        design = extract.get(datasets, "harmonic_balance", name)
        peak = float(design.peak_frequency)
        ends = (1 - AROUND) * peak, (1 + AROUND) * peak
        around.append(
            exact_orbits.covered(exact_orbits.quiet(branches, free), *ends) / (ends[1] - ends[0])
        )
        lower, edge = BELOW * peak, suppression_band(datasets, name).lower
        beside.append(
            exact_orbits.covered(exact_orbits.high(branches, free), lower, edge) / (edge - lower)
        )
        pairs.append(exact_orbits.high_counterparts(design, branches, free))
        response = extract.get(datasets, "response", name)
        in_band = extract.within(response, *extract.band_edges(design))
        shares = extract.share_of_starts(in_band, quiet_motions(in_band, free))
        single.append(float(shares.min()))
    pairs = pd.concat(pairs)
    return {
        "orbit_around": np.min(around),
        "orbits_beside": np.min(beside),
        "single": np.min(single),
        "truly_stable": pairs.stable.mean(),
        "multiplier": pairs.multiplier.median(),
    }


def quiet_motions(response, free):
    """Return the mask of the settled motions in a response that are quiet.

    `response` is a dataset of the stage `response` with a damper, and `free` holds the branches
    without a damper. A quiet motion touches the walls.
    """
    settled = extract.touching(response) & extract.is_outcome(response, "settled")
    return settled & (response.period == 1) & ~high_motions(response, free)


CLAIMS = (
    Claim(
        number="3",
        text="Whatever omega_l, (7) has a stable low-amplitude solution around Wp, the only one in "
        "the suppression band; a stable high-amplitude one coexists outside the band.",
        source="section 3, figure 3",
        interpretation="The paper says so of figure 3, which is drawn from (7): the stable "
        "solutions of (7) decide, with d0 by the captions and by (19). For full agreement the "
        "motions that exist must do the same: at Wp for all these designs, and over W for "
        "the dampers of figures 5 and 8, of which omega_l is 0. Low and high "
        "amplitudes are read as quiet and violent. Around Wp means within 10 % of Wp; "
        "outside the band, from 0.75 Wp to its lower edge, because the resonance branch "
        "ends at the upper one. Stable violent orbits of any period count.",
        measures=(
            Measure(
                "around",
                "least share of W within 10 % of Wp with a stable quiet solution of (7)",
                least=1,
                decisive=True,
            ),
            Measure(
                "bands",
                "share of designs with a range of W around Wp in which (7) has one stable solution "
                "with contact",
                least=1,
                decisive=True,
            ),
            Measure(
                "beside",
                "least share of W below the band with a stable violent solution of (7)",
                least=0.5,
                decisive=True,
            ),
            Measure(
                "beside",
                "least share of W below the band with a stable violent solution of (7)",
                least=1,
            ),
            Measure(
                "designs_stable",
                "share of designs with a stable exact quiet orbit at Wp",
                least=1,
            ),
            Measure(
                "orbit_around",
                "least share of the range within 10 % of Wp with a stable quiet orbit, omega_l = 0",
                least=1,
            ),
            Measure(
                "single",
                "least share of random starts, at one W of the band by (7), that lead to the quiet "
                "orbit, omega_l = 0",
                least=1,
            ),
            Measure(
                "orbits_beside",
                "least share of the range below the band with a stable violent orbit, omega_l = 0",
                least=1,
            ),
            Measure(
                "truly_stable",
                "share of the stable violent solutions of (7) whose nearest symmetric orbit with "
                "two contacts is stable, omega_l = 0",
            ),
            Measure(
                "multiplier", "median of the largest Floquet multiplier modulus of these orbits"
            ),
            Measure(
                "design_multiplier",
                "largest Floquet multiplier modulus of the quiet orbits of the designs at Wp",
            ),
            Measure("design_damping", "damping h above which all these quiet orbits are stable"),
            Measure(
                "design_settled",
                "largest share of random starts that lead to a periodic motion at a design with an "
                "unstable quiet orbit",
            ),
            Measure(
                "least_size",
                "smallest max |Z1| of the motions that random starts lead to at these designs, "
                "over the free resonance",
            ),
            Measure("most_size", "largest max |Z1| of these motions, over the free resonance"),
        ),
        evidence=quiet_and_high,
        finding=balance_findings.quiet_and_high,
        figures=("figure_03a", "figure_03b", "figure_03c", "orbits_05a"),
    ),
)
