"""Rules for the optimum clearance against the optimum of the motion."""

from impact_damper.data.variables.variable import MINIMUM, STABILITY, Variable

SWEPT = ("mass_ratio", "restitution", "contact_stiffness", "frequency")
BEST = (*SWEPT, "criterion")

VARIABLES = {
    "mass_ratio": Variable(("mass_ratio",), "mass ratio", "r_m"),
    "criterion": Variable(("criterion",), "what is least at an optimum"),
    "rule": Variable(("rule",), "rule for the clearance"),
    "best_ratio": Variable(BEST, "r_m Omega^2 d0 at the optimum"),
    "best_size": Variable(BEST, "Omega^2 times what is least there"),
    "best_kind": Variable(BEST, "kind of minimum", flags=MINIMUM),
    "best_multiplier": Variable(BEST, "modulus of the dominant Floquet multiplier there"),
    "best_stability": Variable(BEST, "stability of the motion there", flags=STABILITY),
    "rule_ratio": Variable((*BEST, "rule"), "r_m Omega^2 d0 by the rule"),
    "rule_excess": Variable(
        (*SWEPT, "rule"), "max |Z1| at the rule's clearance over the least, less one"
    ),
}
