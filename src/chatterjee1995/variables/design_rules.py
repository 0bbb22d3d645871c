"""Rules for the optimum clearance, and the optimum of the exact quiet motion."""

from impact_damper.data.variables.variable import MINIMUM, STABILITY, Variable

SWEPT = ("mass_ratio", "restitution", "contact_stiffness", "frequency")
BEST = (*SWEPT, "criterion")

VARIABLES = {
    "mass_ratio": Variable(("mass_ratio",), "mass ratio", "r_m"),
    "criterion": Variable(("criterion",), "quantity that is smallest at an optimum"),
    "rule": Variable(("rule",), "rule for the clearance"),
    "best_ratio": Variable(BEST, "r_m Omega^2 d0 (dimensionless clearance) at the optimum"),
    "best_size": Variable(BEST, "value of the criterion at the optimum, times Omega^2"),
    "best_kind": Variable(BEST, "kind of minimum", flags=MINIMUM),
    "best_multiplier": Variable(BEST, "modulus of the dominant Floquet multiplier at the optimum"),
    "best_stability": Variable(BEST, "stability of the motion at the optimum", flags=STABILITY),
    "rule_ratio": Variable((*BEST, "rule"), "r_m Omega^2 d0 by the rule"),
    "rule_excess": Variable(
        (*SWEPT, "rule"),
        "relative excess of max |Z1|, at the clearance by the rule, above the smallest max |Z1|",
    ),
}
