"""Claims on simulated motions: 4 to 8 and 17 (section 3, figures 4, 5 and 8)."""

import numpy as np

from impact_damper.claims import extract
from impact_damper.claims.balance import CAPTIONS, RULES
from impact_damper.claims.claim import Claim, Missing, Number

BY_MASS = ("figure_05a", "figure_05b", "figure_05c")
ELASTIC = (*BY_MASS, "figure_08")
INELASTIC = "figure_10"


def growth(widths):
    """Least ratio of a width to the one before."""
    widths = np.asarray(widths, float)
    return float(np.min(widths[1:] / widths[:-1]))


def widening(datasets):
    """Numbers of claim 4."""
    captions = extract.select(datasets, "design", CAPTIONS)
    rules = extract.select(datasets, "design", RULES)
    masses = extract.select(datasets, "design", BY_MASS)
    elastic, inelastic = (
        extract.simulated_band(response, extract.free_of(datasets, response))
        for response in extract.select(datasets, "response", (BY_MASS[1], INELASTIC)))
    reductions = [float(design.reduction) for design in captions]
    return {
        "linear": growth([design.band_width for design in captions]),
        "linear_rule": growth([design.band_width for design in rules]),
        "mass": growth([design.band_width for design in masses]),
        "restitution": inelastic.least_width / elastic.width,
        "reduction": max(reductions) - min(reductions),
    }


def in_bands(datasets, names):
    """Quiet motions of curves at the frequencies of their suppression bands."""
    return [extract.quiet(extract.within(
        extract.get(datasets, "response", name),
        *extract.band_edges(extract.get(datasets, "design", name)))) for name in names]


def quiet_contacts(datasets):
    """Numbers of claim 5."""
    quiets = in_bands(datasets, ELASTIC)
    two = [np.mean(np.abs(quiet.contacts - 2) < 1e-6) for quiet in quiets]
    skew = [float(quiet.asymmetry.max()) for quiet in quiets]
    return {"two": np.min(two), "skew": np.max(skew)}


def high_motions(datasets):
    """Numbers of claim 6."""
    contacts, settled_contacts, errors, widest, total = [], [], [], [], []
    for name in ELASTIC:
        response = extract.get(datasets, "response", name)
        free = extract.free_of(datasets, response)
        high = extract.high(response, free)
        settled = high & extract.is_outcome(response, "settled")
        contacts.append(response.contacts.values[high.values])
        settled_contacts.append(response.contacts.values[settled.values])
        design = extract.get(datasets, "design", name)
        estimate = np.abs(extract.stable_impacting(design)).max("solution").interp(
            frequency=response.frequency)
        error = np.abs(estimate / response.maximum_displacement - 1).where(settled)
        errors.append(error.values[np.isfinite(error.values)])
        chaotic = extract.chaotic_high(response, free)
        widest.append(extract.longest_run(chaotic) * extract.spacing(response))
        total.append(np.sum(chaotic) * extract.spacing(response))
    contacts, settled_contacts, errors = map(
        np.concatenate, (contacts, settled_contacts, errors))
    if len(settled_contacts) == 0 or len(errors) == 0:
        raise Missing("There is no settled high motion")
    return {"more": np.mean(contacts > 2 + 1e-6), "fewest": settled_contacts.min(),
            "error": np.median(errors), "widest": max(widest), "total": max(total)}


def phases(datasets):
    """Numbers of claim 7, in both readings."""
    below, above, turns, balance, loose_below, loose_above, loose_turns = ([] for _ in range(7))
    for name in BY_MASS:
        design = extract.get(datasets, "design", name)
        quiet = extract.quiet(extract.get(datasets, "response", name))
        peak = float(design.peak_frequency)
        near = quiet.sel(frequency=slice(0.75 * peak, None)).dropna("frequency")
        frequency = near.frequency.values
        relative, loose = (np.abs(near[key].values) for key in ("phase_relative", "phase_loose"))
        under = frequency < peak
        if not under.any() or under.all():
            raise Missing(f"There is no quiet motion on both sides of Wp, response/{name}")
        below.append(np.max(np.pi - relative[under]))
        above.append(relative[-1])
        loose_below.append(np.max(loose[under]))
        loose_above.append(np.pi - loose[-1])
        turns.append(extract.crossing(frequency, relative, np.pi / 2) / peak)
        loose_turns.append(extract.crossing(frequency, loose, np.pi / 2) / peak)
        around = extract.quiet_balance(design).sel(frequency=slice(0.75 * peak, None))
        balance.append(extract.crossing(around.frequency.values, around.values, 0.0) / peak)
    def farthest(ratios):
        return max(ratios, key=lambda ratio: abs(ratio - 1))

    return {"below": max(below), "above": max(above), "turn_balance": farthest(balance),
            "turn": farthest(turns), "loose_below": max(loose_below),
            "loose_above": max(loose_above), "loose_turn": farthest(loose_turns)}


def first_collisions(datasets):
    """Numbers of claim 8."""
    data = list(datasets.get("collisions", {}).values())
    if not data:
        raise Missing("There is no dataset of the stage collisions")

    def worst(name, ball, choose):
        return choose([float(each[name].sel(ball=ball)) for each in data])

    return {"literal": worst("colliding", "literal", min),
            "within_gap": worst("colliding", "within_gap", min),
            "beyond_wall": worst("beyond_wall", "literal", max),
            "wait": worst("longest_wait", "literal", max)}


def amplitude_by_mass(datasets):
    """Numbers of claim 17, at the frequencies of the narrowest band."""
    designs = extract.select(datasets, "design", BY_MASS)
    lower, upper = np.max([extract.band_edges(design)[0] for design in designs]), np.min(
        [extract.band_edges(design)[1] for design in designs])
    sizes = [extract.quiet(extract.within(response, lower, upper)).maximum_displacement.mean()
             for response in extract.select(datasets, "response", BY_MASS)]
    balance = [np.abs(extract.quiet_balance(extract.within(design, lower, upper))).mean()
               for design in designs]
    steps = np.array(sizes[1:]) / np.array(sizes[:-1])
    return {"steps": np.max(steps), "whole": float(sizes[-1] / sizes[0]),
            "balance": np.max(np.array(balance[1:]) / np.array(balance[:-1]))}


CLAIMS = (
    Claim(
        "4", "The suppression band widens with omega_l, with rm and with lower e; the reduction "
        "in it barely depends on omega_l.", "sections 3 and 4, figures 3, 5 and 10",
        "Width by harmonic balance, for e by the motions that exist. Reduction: 1 - |a|/(free "
        "amplitude) at Wp, with the captions' clearances.",
        (
            Number("linear", "least ratio of a width to that at the omega_l before, captions' d0",
                   least=1, decisive=True),
            Number("linear_rule", "the same with d0 of (19)", least=1),
            Number("mass", "least ratio of a width to that at the rm before", least=1,
                   decisive=True),
            Number("restitution", "width for e = 0.75, at least, over that for e = 1", least=1,
                   decisive=True),
            Number("reduction", "spread of the reduction over omega_l", most=0.1),
        ),
        widening,
    ),
    Claim(
        "5", "The low-amplitude motion has two symmetric impacts per cycle.",
        "section 3, figure 4", "The smallest settled motion with contacts, in the suppression "
        "band, for all elastic dampers of figures 5 and 8.",
        (
            Number("two", "least share of frequencies at which it has two contacts a period",
                   least=1, decisive=True),
            Number("skew", "largest distance from its mirror image half a period on", most=1e-6,
                   decisive=True),
        ),
        quiet_contacts,
    ),
    Claim(
        "6", "The high-amplitude motion has more than two impacts per cycle and agrees with "
        "harmonic balance; regions of different impact number are separated by narrow chaotic "
        "regimes.", "section 3, figure 5",
        "High: above half of the free resonance. Narrow: no wider than 0.1 in W.",
        (
            Number("more", "share of high motions with more than two contacts a period", least=0.5,
                   decisive=True),
            Number("error", "median relative difference of settled high motions to |a|", most=0.1,
                   decisive=True),
            Number("fewest", "fewest contacts a period of a settled high motion", least=2.01),
            Number("widest", "widest range of W in which a high motion is chaotic", most=0.1),
            Number("total", "most of W, for one damper, in which a high motion is chaotic"),
        ),
        high_motions,
    ),
    Claim(
        "7", "Primary and loose mass move almost in antiphase for W < Wp, almost in phase for "
        "W > Wp.", "section 3, figure 5",
        "The paper's phase is that of Z1 to Z2, the sign of a; for the place x2 = Z1 - Z2 of the "
        "loose mass it is the reverse where |a| < b. Quiet motion, from 0.75 Wp on; phases of the "
        "first harmonics in radian; almost: within 0.3. Of three dampers the farthest from the claim.",
        (
            Number("below", "largest distance to antiphase of Z1 and Z2 below Wp", most=0.3,
                   decisive=True),
            Number("above", "largest distance to phase of Z1 and Z2 at the highest W", most=0.3,
                   decisive=True),
            Number("turn_balance", "W/Wp where a changes sign by harmonic balance",
                   least=0.95, most=1.05),
            Number("turn", "W/Wp where Z1 and Z2 are a quarter apart, simulated",
                   least=0.95, most=1.05),
            Number("loose_below", "largest distance to phase of Z1 and x2 below Wp"),
            Number("loose_above", "largest distance to antiphase of Z1 and x2 at the highest W"),
            Number("loose_turn", "W/Wp where Z1 and x2 are a quarter apart"),
        ),
        phases,
    ),
    Claim(
        "8", "Random initial conditions in a ball of radius 2 all lead to collisions.",
        "section 3", "The literal ball, which reaches beyond the walls, and the ball within the "
        "gap; for the dampers of figure 5 at the design frequency.",
        (
            Number("literal", "least share that collides, literal ball", least=0.99,
                   decisive=True),
            Number("within_gap", "least share that collides, ball within the gap", least=0.99,
                   decisive=True),
            Number("literal", "least share that collides, literal ball", least=1),
            Number("within_gap", "least share that collides, ball within the gap", least=1),
            Number("beyond_wall", "largest share of the literal ball beyond a wall"),
            Number("wait", "longest wait for a collision, forcing periods"),
        ),
        first_collisions,
    ),
    Claim(
        "17", "The larger rm, the lower the amplitude in the suppression band.",
        "section 3, figure 5", "Mean of max |Z1| of the quiet motion over the frequencies that "
        "lie in the suppression bands of all three dampers.",
        (
            Number("whole", "amplitude at the largest rm over that at the smallest", most=1,
                   decisive=True),
            Number("steps", "largest ratio of an amplitude to that at the rm before", most=1),
            Number("balance", "the same by harmonic balance", most=1),
        ),
        amplitude_by_mass,
    ),
)
