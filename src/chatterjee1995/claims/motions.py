"""Claims 5, 6 and 8, on the motions with the damper (section 3, figures 4, 5 and 8).

A motion is violent (of high amplitude) if its largest displacement |Z1| exceeds half of that on the
resonance branch without the damper, at the same forcing frequency W. A quiet motion (of low
amplitude) has the period of the forcing and is not violent. A start is a random initial state.
Equation (7) of the paper is harmonic balance with elastic contacts.

A stage is a step of the workflow.
"""

import numpy as np
import pandas as pd

from chatterjee1995.claims import exact_orbits, extract
from chatterjee1995.claims.claim import Claim, Measure, Missing
from chatterjee1995.claims.findings import motions as motions_findings
from chatterjee1995.claims.suppression import chaotic_high, high_motions


def quiet_contacts(datasets):
    """Return the measures of claim 5: the quiet motion has two symmetric impacts in a cycle."""
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
    """Return the measures of claim 6: a violent motion has more than two impacts, or is chaotic."""
    contacts, fewest, orbits, twins, widest, total, lives = [], [], [], [], [], [], []
    starts, beside = [], []
    for name in extract.ELASTIC:
        response = extract.get(datasets, "response", name)
        branches, free = exact_orbits.of_curve(datasets, name)
        contacts.append(response.contacts.values[high_motions(response, free).values])
        high = exact_orbits.high(branches, free)
        fewest.append(high.fewest.min())
        beside.append(exact_orbits.coexisting(high, "contacts"))
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
        raise Missing(
            "There is no violent motion, or no stable violent orbit at a W at which (7) has a "
            "stable violent solution"
        )
    return {
        "more": np.mean(contacts > 2 + 1e-6),
        "fewest": np.nanmin(fewest),
        "fewest_in": extract.ELASTIC[np.nanargmin(fewest)],
        "harmonic": np.abs(orbits.a / orbits.amplitude.abs() - 1).median(),
        "size": np.abs(orbits.a / orbits["size"] - 1).median(),
        "coexisting": max(beside),
        "coexisting_in": extract.ELASTIC[np.argmax(beside)],
        "twin": twins.difference.median(),
        "widest": max(widest),
        "widest_in": extract.ELASTIC[np.argmax(widest)],
        "widest_first": widest[0],
        "total": max(total),
        "starts": max(starts),
        "lasting": np.mean(lives) if (lives := np.concatenate(lives)).size else np.nan,
    }


def _lasting(response, free):
    """Return whether each violent chaotic motion lasted, shape (n,) of bool.

    Several runs follow each such motion. It lasted if it ended in none of them. Motions without
    such runs are left out.
    """
    chaotic = high_motions(response, free) & extract.is_outcome(response, "chaotic")
    ends = response.life_ends.transpose(*chaotic.dims).values[chaotic.values]
    return ends[ends >= 0] == 0


def first_collisions(datasets):
    """Return the measures of claim 8: random starts in a ball of radius 2 lead to collisions."""
    data = list(datasets.get("collisions", {}).values())
    if not data:
        raise Missing("There is no dataset of the stage collisions")

    data = sorted(data, key=lambda each: -extract.parameter(each, "clearance"))

    def numbers(name, ball):
        return [float(each[name].sel(ball=ball)) for each in data]

    return {
        "literal": min(numbers("colliding", "literal")),
        "within_gap": min(numbers("colliding", "within_gap")),
        "beyond_wall": max(numbers("beyond_wall", "literal")),
        "wait": max(numbers("longest_wait", "within_gap")),
        "clearances": [extract.parameter(each, "clearance") for each in data],
        "beyond_walls": numbers("beyond_wall", "literal"),
        "waits": numbers("longest_wait", "within_gap"),
        "starts": max(extract.parameter(each, "starts") for each in data),
    }


CLAIMS = (
    Claim(
        number="5",
        text="The low-amplitude motion has two symmetric impacts per cycle.",
        source="section 3, figure 4",
        interpretation="All stable quiet orbits in the suppression band by (7) count, for the "
        "elastic dampers of figures 5 and 8, of which omega_l is 0. Coexisting motions of other "
        "periods do not count.",
        measures=(
            Measure(
                "two",
                "least share of the band by (7) in which such orbits exist, all with two contacts "
                "a cycle",
                least=1,
                decisive=True,
            ),
            Measure(
                "skew",
                "largest difference of Z1, Z1', Z2 or Z2' of such an orbit from the mirror image "
                "half a cycle later",
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
        "responses, chaotic ones included. The amplitude |a| of harmonic balance is compared with "
        "the first harmonic of the stable violent orbits of any period. Regions of different "
        "impact number are ranges of W with stable violent orbits that have this number; regions "
        "are separated if they overlap by 0.005 at most. A narrow chaotic range is at most 0.1 "
        "wide in W.",
        measures=(
            Measure(
                "more",
                "share of violent motions with more than two contacts a cycle",
                least=0.5,
                decisive=True,
            ),
            Measure(
                "harmonic",
                "median relative difference between |a| and the first harmonic of stable violent "
                "orbits",
                most=0.1,
                decisive=True,
            ),
            Measure(
                "size",
                "median relative difference between |a| and max |Z1| of stable violent orbits",
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
                "coexisting",
                "width in W over which stable violent orbits with different numbers of contacts "
                "coexist, largest value of a damper",
                most=0.005,
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
        text="Random initial conditions in a ball of radius 2 all lead to collisions; special "
        "ones may not.",
        source="section 3 (iii)",
        interpretation="The ball is read literally, so that it extends beyond the walls, where a "
        "start counts as a collision, and also restricted to the gap. At the design frequency, "
        "for each damper of figure 5, at least 99 % of the random starts must lead to a collision "
        "within 2000 cycles, for full agreement all. Special initial conditions do exist: started "
        "on the non-resonance branch without the damper, where max |Z1| is below d0, with the "
        "loose mass at rest in the middle, the masses never collide.",
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
            Measure(
                "wait", "longest time to the first collision from a start within the gap, in cycles"
            ),
        ),
        evidence=first_collisions,
        finding=motions_findings.first_collisions,
    ),
)
