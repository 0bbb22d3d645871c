"""The two rules for the end of a contact, and the damping ratio that gives a restitution.

During a contact u'' + 2 z u' + u = 0, if no other forces act. u is the depth of the loose mass in
the wall, z the damping ratio, and u + 2 z u' the force of the wall. The unit of time is 1/n, where
n is the natural frequency of the contact.

By the rule `zero_penetration` (of the paper) a contact ends when u = 0. Equation (25) gives z. If
z > 0, the wall pulls at the end. By the rule `no_tension` a contact ends when the force of the wall
falls to 0. If z < 1, the restitution is exp(-(pi - 2 A) tan A) with z = sin(A) (Schwager and
Poeschel, Physical Review E 78, 2008, 051304). If z > 1, it is exp(-2 B coth B) with z = cosh(B).
"""

import math
from functools import cache

ZERO_PENETRATION, NO_TENSION = EXIT_RULES = ("zero_penetration", "no_tension")
# Damping ratios closer to 1 than CRITICAL are treated as 1, critical damping.
CRITICAL = 1e-6


def restitution(ratio) -> float:
    """Return the restitution of a contact with this damping ratio, by the rule `no_tension`."""
    if abs(ratio - 1) < CRITICAL:
        return math.exp(-2)
    if ratio < 1:
        angle = math.asin(ratio)
        return math.exp(-(math.pi - 2 * angle) * math.tan(angle))
    argument = math.acosh(ratio)
    return math.exp(-2 * argument / math.tanh(argument))


@cache
def damping_ratio(restitution_, rule=ZERO_PENETRATION) -> float:
    """Return the damping ratio of contacts that end by `rule` and have this restitution."""
    logarithm = math.log(1 / restitution_)
    if rule == ZERO_PENETRATION or not logarithm:
        return logarithm / math.hypot(math.pi, logarithm)
    from scipy.optimize import brentq  # a slow import; Snakemake's dry runs do without it

    return brentq(lambda z: restitution(z) - restitution_, 0.0, 10.0, xtol=1e-15, rtol=1e-14)
