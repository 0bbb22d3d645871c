"""Claims on simulated motions: 5, 6 and 8 (section 3, figures 4, 5 and 8)."""

import numpy as np

from impact_damper.claims import extract
from impact_damper.claims.claim import Claim, Missing, Number


def in_bands(datasets, names):
    """Quiet motions of curves at the frequencies of their suppression bands."""
    return [
        extract.quiet(
            extract.within(
                extract.get(datasets, "response", name),
                *extract.band_edges(extract.get(datasets, "design", name)),
            )
        )
        for name in names
    ]


def quiet_contacts(datasets):
    """Numbers of claim 5."""
    quiets = in_bands(datasets, extract.ELASTIC)
    two = [np.mean(np.abs(quiet.contacts - 2) < 1e-6) for quiet in quiets]
    skew = [float(quiet.asymmetry.max()) for quiet in quiets]
    return {"two": np.min(two), "skew": np.max(skew)}


def high_motions(datasets):
    """Numbers of claim 6."""
    contacts, settled_contacts, errors, widest, total = [], [], [], [], []
    for name in extract.ELASTIC:
        response = extract.get(datasets, "response", name)
        free = extract.free_of(datasets, response)
        high = extract.high(response, free)
        settled = high & extract.is_outcome(response, "settled")
        contacts.append(response.contacts.values[high.values])
        settled_contacts.append(response.contacts.values[settled.values])
        design = extract.get(datasets, "design", name)
        estimate = (
            np.abs(extract.stable_impacting(design))
            .max("solution")
            .interp(frequency=response.frequency)
        )
        error = np.abs(estimate / response.maximum_displacement - 1).where(settled)
        errors.append(error.values[np.isfinite(error.values)])
        chaotic = extract.chaotic_high(response, free)
        widest.append(extract.longest_run(chaotic) * extract.spacing(response))
        total.append(np.sum(chaotic) * extract.spacing(response))
    contacts, settled_contacts, errors = map(np.concatenate, (contacts, settled_contacts, errors))
    if len(settled_contacts) == 0 or len(errors) == 0:
        raise Missing("There is no settled high motion")
    return {
        "more": np.mean(contacts > 2 + 1e-6),
        "fewest": settled_contacts.min(),
        "error": np.median(errors),
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
        "The smallest settled motion with contacts, in the suppression "
        "band, for all elastic dampers of figures 5 and 8.",
        (
            Number(
                "two",
                "least share of frequencies at which it has two contacts a period",
                least=1,
                decisive=True,
            ),
            Number(
                "skew",
                "largest distance from its mirror image half a period on",
                most=1e-6,
                decisive=True,
            ),
        ),
        quiet_contacts,
    ),
    Claim(
        "6",
        "The high-amplitude motion has more than two impacts per cycle and agrees with "
        "harmonic balance; regions of different impact number are separated by narrow chaotic "
        "regimes.",
        "section 3, figure 5",
        "High: above half of the free resonance. Narrow: no wider than 0.1 in W.",
        (
            Number(
                "more",
                "share of high motions with more than two contacts a period",
                least=0.5,
                decisive=True,
            ),
            Number(
                "error",
                "median relative difference of settled high motions to |a|",
                most=0.1,
                decisive=True,
            ),
            Number("fewest", "fewest contacts a period of a settled high motion", least=2.01),
            Number("widest", "widest range of W in which a high motion is chaotic", most=0.1),
            Number("total", "most of W, for one damper, in which a high motion is chaotic"),
        ),
        high_motions,
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
