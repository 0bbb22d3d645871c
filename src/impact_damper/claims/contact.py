"""Claim 15, on the model of inelastic contact (appendix B)."""

import math

from impact_damper.claims import exact, extract
from impact_damper.claims.claim import Claim, Missing, Number
from impact_damper.contact.contact_law import damping_ratio

LOW = 0.3


def duration(restitution):
    """Time in contact over that of an elastic contact, 1/sqrt(1 - z^2)."""
    return 1 / math.sqrt(1 - damping_ratio(restitution) ** 2)


def pull_free_error(restitution):
    """Relative excess of the restitution over e if contact ends when the force vanishes.

    The force -y'' vanishes at wd t = pi - 2 asin(z), while the penetration y is positive; from
    there to the end of the contact the walls pull.
    """
    damping = damping_ratio(restitution)
    return math.exp(2 * math.asin(damping) * damping * duration(restitution)) - 1


def model(datasets):
    """Numbers of claim 15: the e that the datasets use, and a low one."""
    used = [
        extract.parameter(data, "restitution")
        for stage in ("response", "optimum")
        for data in datasets.get(stage, {}).values()
    ]
    used = [value for value in used if value < 1]
    if not used:
        raise Missing("There is no dataset with inelastic contact")
    curve = exact.of_curve(datasets, extract.INELASTIC)
    kept = exact.quiet(*curve).restitution / extract.parameter(curve[0], "restitution")
    return {
        "realised": (kept - 1).abs().max(),
        "high": max(map(pull_free_error, used)),
        "low": pull_free_error(LOW),
        "pulling": 2 * math.asin(damping_ratio(LOW)) / math.pi,
        "duration": duration(LOW),
    }


CLAIMS = (
    Claim(
        "15",
        "The contact model with (25) is good for high e and fails for low e.",
        "appendix B",
        "Good: walls that cannot pull would return nearly the same share of the "
        "velocity. From the closed form of an isolated contact, for the e < 1 of the datasets "
        f"and for e = {LOW}; and from the contacts of the exact quiet orbits of figure 10, which "
        "the forcing and the spring of the primary act on meanwhile. The paper's reason is that a "
        "contact takes longer.",
        (
            Number(
                "high",
                "largest relative excess of the restitution without pull, e of the datasets",
                most=0.05,
                decisive=True,
            ),
            Number("low", f"the same for e = {LOW}", least=0.2, decisive=True),
            Number(
                "realised",
                "largest relative difference to e of the restitution in quiet orbits, e = 0.75",
                most=0.05,
                decisive=True,
            ),
            Number("duration", f"time in contact for e = {LOW} over that for e = 1", least=1.2),
            Number("pulling", f"share of it in which the wall pulls, e = {LOW}"),
        ),
        model,
    ),
)
