"""Variables of the stage `release_policies`."""

from impact_damper.data.variables import register

# Words for the policies of release in tables and figures.
POLICIES = {
    "settled": "random phase once settled",
    "hold": "fixed number of cycles",
    "phase": "fixed phase",
    "state": "state in the goal's basin",
}

register(
    """
case | case | | | index of a damper
policy | policy | | | policy by which the damper is switched off
quantile | quantile | | | quantile over all trials
case_mass_ratio | case | | rm | mass ratio of a damper
case_clearance | case | clearance | d0 | clearance of a damper
case_restitution | case | | e | coefficient of restitution of a damper
policy_success | case frequency policy bound | | | share of trials that reach the goal within 350
  cycles
policy_cycles | case frequency policy quantile bound | | | cycles until the motion has settled on
  the goal, infinite without success
policy_damper | case frequency policy bound | | | median of the cycles with the damper on
policy_impacts | case frequency policy bound | | | median of the impacts
policy_releases | case frequency policy | | | mean number of releases
policy_hold | case frequency policy | | | cycles for which the policy keeps the damper on; for
  release by state, at most
policy_phase | case frequency policy | angle | | phase Omega T of the release that the policy
  chose
realised_share | case frequency bound | | | share of releases at every phase, ten cycles after
  switching on, that reach the goal
    """,
)
