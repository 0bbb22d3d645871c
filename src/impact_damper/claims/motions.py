"""Claims on the motions with the damper: 5, 6 and 8 (section 3, figures 4, 5 and 8)."""

import numpy as np
import pandas as pd

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Claim, Missing, Number
from impact_damper.claims.suppression import chaotic_high, high_motions


def quiet_contacts(datasets):
    """Numbers of claim 5."""
    shares, skew, multipliers = [], [], []
    for name in extract.ELASTIC:
        lower, upper = extract.band_edges(extract.get(datasets, "design", name))
        quiet = exact.quiet(*exact.of_curve(datasets, name))
        there = quiet[(quiet.upper > lower) & (quiet.lower < upper)]
        other = there[(there.fewest != 2) | (there.contacts != 2)]
        twos = exact.covered(there, lower, upper) - exact.covered(other, lower, upper)
        shares.append(twos / (upper - lower))
        skew.append(there.asymmetry.max())
        multipliers.append(there.multiplier.max())
    return {
        "two": np.min(shares),
        "skew": np.max(skew),
        "multiplier": np.max(multipliers),
    }


def high_and_chaotic(datasets):
    """Numbers of claim 6."""
    contacts, fewest, orbits, twins, widest, total = [], [], [], [], [], []
    for name in extract.ELASTIC:
        response = extract.get(datasets, "response", name)
        branches, free = exact.of_curve(datasets, name)
        contacts.append(response.contacts.values[high_motions(response, free).values])
        high = exact.high(branches, free)
        fewest.append(high.fewest.min())
        design = extract.get(datasets, "design", name)
        level = exact.HALF * exact.resonance(free, design.frequency)
        estimate = np.abs(extract.stable_impacting(design)).max("solution").to_series()
        found = exact.crossings(high, design.frequency)
        orbits.append(found.assign(a=found.frequency.map(estimate[estimate > level])))
        twins.append(exact.high_counterparts(design, branches, free))
        chaotic = chaotic_high(response, free).values
        widest.append(extract.longest_run(chaotic) * extract.spacing(response))
        total.append(np.sum(chaotic) * extract.spacing(response))
    contacts, orbits, twins = np.concatenate(contacts), pd.concat(orbits), pd.concat(twins)
    if len(contacts) == 0 or not orbits.a.notna().any():
        raise Missing("There is no stable high orbit beside a solution of (7)")
    return {
        "more": np.mean(contacts > 2 + 1e-6),
        "fewest": np.nanmin(fewest),
        "error": np.abs(orbits.a / orbits["size"] - 1).median(),
        "harmonic": np.abs(orbits.a / orbits.amplitude.abs() - 1).median(),
        "twin": twins.difference.median(),
        "widest": max(widest),
        "total": max(total),
    }


def first_collisions(datasets):
    """Numbers of claim 8."""
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
        "5",
        "The low-amplitude motion has two symmetric impacts per cycle.",
        "section 3, figure 4",
        "Every stable orbit of period 1 below half of the free resonance, in the suppression band "
        "by harmonic balance, for all elastic dampers of figures 5 and 8.",
        (
            Number(
                "two",
                "least share of the band with such an orbit and two contacts a period in each",
                least=1,
                decisive=True,
            ),
            Number(
                "skew",
                "largest distance from its mirror image half a period on",
                most=1e-6,
                decisive=True,
            ),
            Number("multiplier", "largest modulus of a Floquet multiplier of such an orbit"),
        ),
        quiet_contacts,
    ),
    Claim(
        "6",
        "The high-amplitude motion has more than two impacts per cycle and agrees with "
        "harmonic balance; regions of different impact number are separated by narrow chaotic "
        "regimes.",
        "section 3, figure 5",
        "High: above half of the free resonance. Contacts of all high motions, chaotic ones "
        "included, at the frequencies of the responses; harmonic balance against max |Z1| of "
        "the stable high orbits, of any period, and beside it their first harmonic. Narrow: no "
        "wider than 0.1 in W.",
        (
            Number(
                "more",
                "share of high motions with more than two contacts a period",
                least=0.5,
                decisive=True,
            ),
            Number(
                "error",
                "median relative difference of |a| to max |Z1| of stable high orbits",
                most=0.1,
                decisive=True,
            ),
            Number("harmonic", "median relative difference of |a| to their first harmonic"),
            Number(
                "twin",
                "the same of the orbit that |a| stands for, symmetric with two contacts, stable "
                "or not",
            ),
            Number("fewest", "fewest contacts a period of a stable high orbit", least=2.01),
            Number("widest", "widest range of W in which a high motion is chaotic", most=0.1),
            Number("total", "most of W, for one damper, in which a high motion is chaotic"),
        ),
        high_and_chaotic,
    ),
    Claim(
        "8",
        "Random initial conditions in a ball of radius 2 all lead to collisions.",
        "section 3",
        "The literal ball, which reaches beyond the walls, and the ball within the "
        "gap; for the dampers of figure 5 at the design frequency.",
        (
            Number("literal", "least share that collides, literal ball", least=0.99, decisive=True),
            Number(
                "within_gap",
                "least share that collides, ball within the gap",
                least=0.99,
                decisive=True,
            ),
            Number("literal", "least share that collides, literal ball", least=1),
            Number("within_gap", "least share that collides, ball within the gap", least=1),
            Number("beyond_wall", "largest share of the literal ball beyond a wall"),
            Number("wait", "longest wait for a collision, forcing periods"),
        ),
        first_collisions,
    ),
)
