"""Claims 5, 6 and 8, on the motions with the damper (section 3, figures 4, 5 and 8).

A motion has high amplitude if its max |Z1| exceeds half that of the free resonance branch.
"""

import numpy as np
import pandas as pd

from impact_damper.claims import exact_orbits, extract
from impact_damper.claims.claim import Claim, Measure, Missing
from impact_damper.claims.findings import motions as motions_findings
from impact_damper.claims.suppression import chaotic_high, high_motions


def quiet_contacts(datasets):
    """Measures of claim 5: the low-amplitude motion has two symmetric impacts per cycle."""
    shares, skew, multipliers = [], [], []
    for name in extract.ELASTIC:
        lower, upper = extract.band_edges(extract.get(datasets, "harmonic_balance", name))
        quiet = exact_orbits.quiet(*exact_orbits.of_curve(datasets, name))
        in_band = quiet[(quiet.upper > lower) & (quiet.lower < upper)]
        not_two = in_band[(in_band.fewest != 2) | (in_band.contacts != 2)]
        width = exact_orbits.covered(in_band, lower, upper)
        width -= exact_orbits.covered(not_two, lower, upper)
        shares.append(width / (upper - lower))
        skew.append(in_band.asymmetry.max())
        multipliers.append(in_band.multiplier.max())
    return {
        "two": np.min(shares),
        "skew": np.max(skew),
        "multiplier": np.max(multipliers),
    }


def high_and_chaotic(datasets):
    """Measures of claim 6: the high-amplitude motion has more than two impacts, or is chaotic."""
    contacts, fewest, orbits, twins, widest, total, lives = [], [], [], [], [], [], []
    starts = []
    for name in extract.ELASTIC:
        response = extract.get(datasets, "response", name)
        branches, free = exact_orbits.of_curve(datasets, name)
        contacts.append(response.contacts.values[high_motions(response, free).values])
        high = exact_orbits.high(branches, free)
        fewest.append(high.fewest.min())
        design = extract.get(datasets, "harmonic_balance", name)
        level = exact_orbits.HALF * exact_orbits.resonance(free, design.frequency)
        estimate = np.abs(extract.stable_impacting(design)).max("solution").to_series()
        crossings = exact_orbits.crossings(high, design.frequency)
        orbits.append(crossings.assign(a=crossings.frequency.map(estimate[estimate > level])))
        twins.append(exact_orbits.high_counterparts(design, branches, free))
        chaotic = chaotic_high(response, free).values
        widest.append(extract.longest_run(chaotic) * extract.spacing(response))
        lives.append(_lasting(response, free))
        violent = high_motions(response, free)
        chaos = violent & extract.is_outcome(response, "chaotic")
        starts.append(extract.share_of_starts(response, chaos).max())
        total.append(np.sum(chaotic) * extract.spacing(response))
    contacts, orbits, twins = np.concatenate(contacts), pd.concat(orbits), pd.concat(twins)
    if len(contacts) == 0 or not orbits.a.notna().any():
        raise Missing("There is no stable violent orbit beside a solution of (7)")
    return {
        "more": np.mean(contacts > 2 + 1e-6),
        "fewest": np.nanmin(fewest),
        "error": np.abs(orbits.a / orbits["size"] - 1).median(),
        "harmonic": np.abs(orbits.a / orbits.amplitude.abs() - 1).median(),
        "twin": twins.difference.median(),
        "widest": max(widest),
        "total": max(total),
        "starts": max(starts),
        "lasting": np.mean(lives) if (lives := np.concatenate(lives)).size else np.nan,
    }


def _lasting(response, free):
    """Return whether each violent chaos lasted in all runs by which its life was measured."""
    chaotic = high_motions(response, free) & extract.is_outcome(response, "chaotic")
    ends = response.life_ends.transpose(*chaotic.dims).values[chaotic.values]
    return ends[ends >= 0] == 0


def first_collisions(datasets):
    """Measures of claim 8: random starts in a ball of radius 2 all lead to collisions."""
    data = list(datasets.get("collisions", {}).values())
    if not data:
        raise Missing("There is no dataset of the stage collisions")

    def worst(name, ball, choose):
        return choose([float(each[name].sel(ball=ball)) for each in data])

    return {
        "literal": worst("colliding", "literal", min),
        "within_gap": worst("colliding", "within_gap", min),
        "beyond_wall": worst("beyond_wall", "literal", max),
        "wait": worst("longest_wait", "literal", max),
    }


CLAIMS = (
    Claim(
        number="5",
        text="The low-amplitude motion has two symmetric impacts per cycle.",
        source="section 3, figure 4",
        interpretation="All stable orbits of period 1 below half of the free resonance count, in "
        "the suppression band of harmonic balance, for the elastic dampers of figures 5 and 8.",
        measures=(
            Measure(
                "two",
                "least share of the band in which such orbits exist, all with two contacts a cycle",
                least=1,
                decisive=True,
            ),
            Measure(
                "skew",
                "largest distance of such an orbit from its mirror image half a cycle later",
                most=1e-6,
                decisive=True,
            ),
            Measure("multiplier", "largest Floquet multiplier modulus of such an orbit"),
        ),
        evidence=quiet_contacts,
        finding=motions_findings.quiet_contacts,
        figures=("figure_04",),
    ),
    Claim(
        number="6",
        text="The high-amplitude motion has more than two impacts per cycle and agrees with "
        "harmonic balance; regions of different impact number are separated by narrow chaotic "
        "regimes.",
        source="section 3, figure 5",
        interpretation="High amplitude is read as a violent motion, above half of the free "
        "resonance. Contacts are counted for all violent motions at the frequencies of the "
        "responses, chaotic ones included. Harmonic balance is compared with max |Z1| of the "
        "stable violent orbits of any period. A narrow range is at most 0.1 wide in W.",
        measures=(
            Measure(
                "more",
                "share of violent motions with more than two contacts a cycle",
                least=0.5,
                decisive=True,
            ),
            Measure(
                "error",
                "median relative difference between |a| and max |Z1| of stable violent orbits",
                most=0.1,
                decisive=True,
            ),
            Measure(
                "harmonic",
                "median relative difference between |a| and the first harmonic of stable violent "
                "orbits",
            ),
            Measure(
                "twin",
                "median relative difference between |a| and the first harmonic of the nearest "
                "symmetric orbit with two contacts, stable or unstable",
            ),
            Measure(
                "fewest",
                "least number of contacts a cycle of a stable violent orbit",
                least=2.01,
            ),
            Measure(
                "widest", "width in W of the widest range with a chaotic violent motion", most=0.1
            ),
            Measure(
                "total", "total width in W with a chaotic violent motion, largest value of a damper"
            ),
            Measure(
                "starts",
                "largest share of random starts at one W that lead to violent chaos",
            ),
            Measure(
                "lasting",
                "share of the chaotic violent motions none of whose runs ended, all others being "
                "transients",
            ),
        ),
        evidence=high_and_chaotic,
        finding=motions_findings.high_and_chaotic,
        figures=("figure_05a",),
    ),
    Claim(
        number="8",
        text="Random initial conditions in a ball of radius 2 all lead to collisions.",
        source="section 3",
        interpretation="The ball is read literally, so that it extends beyond the walls, and also "
        "restricted to the gap. The least favourable of the dampers of figure 5 counts, at the "
        "design frequency.",
        measures=(
            Measure(
                "literal",
                "least share of starts that collide, literal ball",
                least=0.99,
                decisive=True,
            ),
            Measure(
                "within_gap",
                "least share of starts that collide, ball within the gap",
                least=0.99,
                decisive=True,
            ),
            Measure("literal", "least share of starts that collide, literal ball", least=1),
            Measure(
                "within_gap", "least share of starts that collide, ball within the gap", least=1
            ),
            Measure("beyond_wall", "largest share of starts in the literal ball beyond a wall"),
            Measure("wait", "longest time to the first collision, in cycles"),
        ),
        evidence=first_collisions,
        finding=motions_findings.first_collisions,
    ),
)
