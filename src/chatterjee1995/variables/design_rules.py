"""Rules for the optimum clearance, and the optimum of the exact quiet motion."""

from impact_damper.data.variables import MINIMUM, STABILITY, register

register(
    """
mass_ratio | mass_ratio | | r_m | mass ratio
criterion | criterion | | | quantity that is smallest at an optimum
rule | rule | | | rule for the clearance
best_ratio | mass_ratio restitution contact_stiffness frequency criterion | | | r_m Omega^2 d0
  (dimensionless clearance) at the optimum
best_size | mass_ratio restitution contact_stiffness frequency criterion | | | value of the
  criterion at the optimum, times Omega^2
best_kind | mass_ratio restitution contact_stiffness frequency criterion | | | kind of minimum
  : MINIMUM
best_stability | mass_ratio restitution contact_stiffness frequency criterion | |  | stability of
  the motion at the optimum
  : STABILITY
rule_ratio | mass_ratio restitution contact_stiffness frequency criterion rule | | | r_m Omega^2
  d0 by the rule
rule_excess | mass_ratio restitution contact_stiffness frequency rule | | | relative excess of max
  |Z1|, at the clearance by the rule, above the smallest max |Z1|
    """,
    MINIMUM=MINIMUM,
    STABILITY=STABILITY,
)
