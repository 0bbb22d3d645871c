"""Policies of migration, rules that say when to switch the damper off, and their success.

Migration leads the motion from the resonance to the goal, the small motion without damper, by
switching the damper on and off. The release set holds the states from which the motion reaches the
goal after the damper is switched off.
"""

from impact_damper.data.variables import register

register(
    """
case | case | | | index of a damper
policy | policy | | | policy by which the damper is switched off
quantile | quantile | | | quantile over all trials
margin | margin | | | least distance of the state from the edge of the goal's basin, over the size
  of the resonance motion
noisy_frequency | noisy_frequency | frequency | Omega | forcing frequency at which disturbances
  are studied
disturbance | disturbance | | | error of the measured state over the size of the resonance motion,
  delay in cycles, or errors of the damping and the force that the controller assumes
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
predicted_share | case frequency bound | | | share of releases that the release set predicts to
  reach the goal
realised_share | case frequency bound | | | share of the same releases that do reach the goal
agreeing_share | case frequency bound | | | share of these releases for which the prediction is
  right
least_impulse | frequency | velocity | | least change of velocity that leads from the resonance to
  the goal, at the best phase
median_impulse | frequency | velocity | | median over phases of the least change of velocity that
  leads to the goal
disturbed_success | case noisy_frequency disturbance margin bound | | | share of trials that reach
  the goal in spite of a disturbance
disturbed_cycles | case noisy_frequency disturbance margin bound | | | median of the cycles until
  the goal in spite of a disturbance
# of the stage release_dampers; along a cut only the restitution of the damper varies
cut_restitution | cut_restitution | | e | coefficient of restitution
resonance_displacement | frequency | displacement | | max |Z1| of the free resonance motion
damper_success | frequency restitution mass_ratio clearance policy bound | | | share of trials
  that reach the goal within 350 cycles
damper_cycles | frequency restitution mass_ratio clearance policy bound | | | median of the cycles
  until the goal
damper_quiet | frequency restitution mass_ratio clearance | displacement | | max |Z1| of the
  smallest periodic motion with the damper on, if it is below half of resonance_displacement
damper_largest | frequency restitution mass_ratio clearance | displacement | | largest max |Z1| of
  the motions with the damper on
cut_success | frequency cut_restitution policy bound | | | share of trials that reach the goal
  within 350 cycles
cut_cycles | frequency cut_restitution policy bound | | | median of the cycles until the goal
cut_quiet | frequency cut_restitution | displacement | | max |Z1| of the smallest periodic motion
  with the damper on, if it is below half of resonance_displacement
cut_largest | frequency cut_restitution | displacement | | largest max |Z1| of the motions with
  the damper on
    """,
)
