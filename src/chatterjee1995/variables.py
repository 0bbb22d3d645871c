"""Variables of datasets that only the paper has, by subject, and their flags.

Figures import this module, so it must not import kernels.
"""

from impact_damper.data.variables import MINIMUM, OUTCOME, STABILITY, SUPPRESSION, register

# Parameters that may change from row to row of a map.
MAPPED = ("damping", "mass_ratio", "clearance", "restitution")
# A settled motion is near a predicted one if max |Z1| differs relatively by at most NEAR.
NEAR = 0.2
BALANCE_VERDICT = {"none": 0, "stable": 1, "unstable": 2, "unresolved": 3}
RUN_MOTION = {
    "not_run": -1,
    "unresolved": 0,
    "quiet": 1,
    "other_low": 2,
    "low_chaotic": 3,
    "high": 4,
    "high_chaotic": 5,
    "no_contact": 6,
}
QUIET_VERDICT = {
    "unresolved": 0,
    "stable_stable": 1,
    "stable_unstable": 2,
    "stable_absent": 3,
    "unstable_stable": 4,
    "unstable_unstable": 5,
    "unstable_absent": 6,
    "none_stable": 7,
    "none_unstable": 8,
    "none_absent": 9,
}
HIGH_VERDICT = {
    "not_run": -1,
    "unresolved": 0,
    "stable_near": 1,
    "stable_far": 2,
    "stable_chaotic": 3,
    "stable_low": 4,
    "stable_no_contact": 5,
    "none_settled": 6,
    "none_chaotic": 7,
    "none_low": 8,
    "none_no_contact": 9,
}
SEARCH = {"converged": 0, "stalled": 1, "iteration_limit": 2}
# Words for the policies of release in tables and figures.
POLICIES = {
    "settled": "random phase once settled",
    "hold": "fixed number of cycles",
    "phase": "fixed phase",
    "state": "state in the goal's basin",
}
AXES = ("mass_ratio", "clearance", "frequency", "restitution")
OUTCOMES = tuple(name for name, value in OUTCOME.items() if value >= 0)

register(
    """
# accuracy
method | run | | | integrator or model
setting | run | | | tolerance of the integrator, or highest harmonic of a harmonic balance
run_status | run | | | end of the run; missed_contacts: fewer contacts than the reference,
  invented_contacts: more contacts
  : ok 0, missed_contacts 1, invented_contacts 2, failed 3, capped 4, not_applicable 5
operations | run | | | floating-point operations of an integrator's run, or of a model's search
  for the orbit; an elementary function counts as 20
state_error | run | | | largest error of a component of the state at the end of the run
contact_time_error | run | | T | largest error of the time at which a contact begins; NaN if the
  number of contacts is wrong
contact_excess | run | | | number of contacts minus the number in the reference
amplitude_error | run | | | relative error of max |Z1|
statistic | statistic | | | name of an average over a chaotic motion
average | run statistic | | | average: contacts per cycle, max |Z1| in a cycle, or largest
  Lyapunov exponent
average_error | run statistic | | | standard error of the average, from its values in batches of
  cycles
reference_average | statistic | | | average in the reference
reference_average_error | statistic | | | standard error of the average in the reference
meets_accuracy | run | | | whether the run meets the accuracy required by the scene
  : no 0, yes 1
# maps of harmonic balance
map_value | map_value | | | value of the parameter that differs between the rows of a map
frequency_ratio | frequency_ratio | | Omega/Omega_p | forcing frequency over the peak frequency
balance_quiet | map_value frequency_ratio | | | stability of the quiet solution of harmonic
  balance by the slow flow
  : BALANCE_VERDICT
balance_quiet_amplitude | map_value frequency_ratio | | |a| | |a| of the quiet solution of
  harmonic balance
quiet_orbit_displacement | map_value frequency_ratio | | max |Z1| | largest displacement in the
  quiet orbit
quiet_orbit_harmonic | map_value frequency_ratio | | | amplitude of the first harmonic of Z1 in
  the quiet orbit
quiet_verdict | map_value frequency_ratio | | | quiet motion: stability by harmonic balance, then
  stability of the exact orbit
  : QUIET_VERDICT
quiet_end | map_value edge | | | Omega/Omega_p at the ends of the range of quiet orbits in a row
quiet_end_event | map_value edge | | | event that ends the range of quiet orbits in a row
  : map_ends 0, fold 1, contacts_change 2, not_converged 3, no_orbit 4
straight_flight_end | map_value | | | Omega/Omega_p at the upper end of quiet orbits, for rigid
  walls at high frequency
quiet_run_motion | map_value frequency_ratio | | | motion to which a start at the quiet solution
  of harmonic balance leads
  : RUN_MOTION
balance_high | map_value frequency_ratio | | | stability of the high solution of harmonic balance
  : BALANCE_VERDICT
high_run_motion | map_value frequency_ratio | | | motion to which the high run leads; the run
  starts at the high solution of harmonic balance or, where none exists, on the free resonance
  branch
  : RUN_MOTION
high_run_outcome | map_value frequency_ratio | | | outcome of the high run
  : OUTCOME
high_verdict | map_value frequency_ratio | | | high motion: result of harmonic balance, then
  motion to which the high run leads
  : HIGH_VERDICT
# contact model
exit_rule | exit_rule | | | rule for the end of a contact
load | load | | g/(omega_n v0) | load in contact
realised_restitution | exit_rule load restitution | | | departure speed divided by approach speed
contact_verdict | exit_rule load restitution | | | realised restitution: within 1 % of e, within 5
  %, or farther; or none, because the loose mass falls back or the contact does not end
  : close 0, fair 1, off 2, falls_back 3, no_release 4
used | used | | e | coefficient of restitution of a damper
unloaded_restitution | exit_rule used | | | realised restitution without load
unloaded_duration | exit_rule used | | | time in contact / time in an elastic contact, without
  load
unloaded_pull_time | used | | | fraction of the time in contact in which the force is tensile
size | size | | | smallest settled or largest motion to which random starts lead
contact_used | contact | | | index along the dimension `used` of a contact
contact_size | contact | | | index along the dimension `size` of a contact
contact_load | contact | | | load at the beginning of a contact
# rigid limit
stiffness | stiffness | | r1 | contact stiffness
rigid_error | frequency stiffness | | | relative error of max |Z1| if walls are taken as rigid
mended_error | frequency stiffness | | | relative error of max |Z1| with corrected rigid walls
rigid_verdict | frequency stiffness | | | which of the compliant and rigid orbits were found, and
  whether their stability agrees
  : both_stable 0, both_unstable 1, stability_differs 2, rigid_only 3, compliant_only 4,
  : neither 5
threshold | threshold | | | relative error of max |Z1| that is allowed
needed_stiffness | threshold frequency | | r1 | contact stiffness above which rigid_error is below
  the threshold
needed_status | threshold frequency | | | whether needed_stiffness lies within, below or above the
  grid
  : absent -1, found 0, below_grid 1, above_grid 2
rigid_order | frequency | | | exponent n of rigid_error ~ r1^-n for short contacts
mended_order | frequency | | | exponent n of mended_error ~ r1^-n for short contacts
own_displacement | | | max |Z1| | largest displacement with the damper's own r1
own_error | | | | relative error of own_displacement if walls are taken as rigid
own_mended_error | | | | relative error of own_displacement with corrected rigid walls
# design rules
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
# harmonics
highest_harmonic | highest_harmonic | | N | highest harmonic
error_measure | error_measure | | | quantity whose error is listed
series_status | highest_harmonic | | | how Newton's method ended when started from the solution
  with fewer harmonics
  : SEARCH
series_error | error_measure highest_harmonic | | | difference from the exact orbit: of max |Z1|,
  and of Z1 in the harmonics up to N and beyond N (root mean square), divided by max |Z1|; and of
  a Floquet multiplier
cold_status | highest_harmonic | | | how Newton's method ended when started from the single-term
  solution
  : not_tried -1, same_motion 0, stalled 1, iteration_limit 2, another_motion 3
hill_status | highest_harmonic | | | how Hill's method ended
  : not_tried -1, found 0, not_separated 1, not_converged 2
exact_status | | | | whether the exact orbit was found
  : not_found 0, found 1
exact_maximum | | displacement | max |Z1| | largest displacement of the exact orbit
asymptotic_harmonic | | | | lowest N whose errors are used in the fit of the decrease
decay_kind | | | | decrease of the errors: a power of N, or exponential
  : algebraic 0, exponential 1
decay_observed | error_measure | | | fitted power of 1/N, or rate per harmonic, at which an error
  decreases
decay_predicted | error_measure | | | predicted power of 1/N, or rate per harmonic
# integrators
integrator | integrator | | | method of integration
method_tolerance | method_tolerance | | | tolerance of the method
# contacts missed near grazing
depth | depth | | | distance by which a passage would go beyond the wall if it were not there
contact_outcome | contact_outcome | | | result of a method at a contact
passage_count | integrator method_tolerance depth contact_outcome | | | number of contacts that a
  method finds, misses between two steps, or does not reach because its motion is inaccurate, and
  number of failed runs
contacts_missed | integrator method_tolerance depth | | | share of completed runs in which the
  contact is not found
spurious_count | integrator method_tolerance depth | | | number of contacts that a method reports
  in passages without contact
motion_error | integrator method_tolerance | | | median error of the largest |Z2| of a passage,
  failed runs excluded
fixed_steps | method_tolerance | | | steps per cycle of the fixed-step method
expected_unseen | method_tolerance depth | | | expected share of contacts at random times that
  begin and end within one fixed step
# largest stable steps
fixed_method | fixed_method | | | method with equal steps
scaled_step | scaled_step | | h omega_c | step times contact frequency
accuracy | accuracy | | | relative deviation allowed in max |Z1|
step_deviation | fixed_method contact_stiffness scaled_step | | | largest relative deviation of
  max |Z1| in any period, infinite if the run diverged
stable_step | fixed_method contact_stiffness accuracy | | h | largest step that keeps the accuracy
  together with all smaller ones
step_slope | fixed_method accuracy | | | slope of log(1/h) as a function of log r1, h the largest
  stable step
step_slope_error | fixed_method accuracy | | | standard error of step_slope
linear_limit | fixed_method | | | largest product of step and contact frequency by linear
  stability theory
contact_frequency | contact_stiffness | | omega_c | natural frequency of an undamped contact
# policies
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
policy_damper | case frequency policy | | | median of the cycles with the damper on
policy_impacts | case frequency policy | | | median of the impacts
policy_releases | case frequency policy | | | mean number of releases
policy_hold | case frequency policy | | | cycles for which the policy keeps the damper on; for
  release by state, at most
policy_phase | case frequency policy | angle | | phase Omega T of the release that the policy
  chose
# studies
cell | cell | | | number of the cell in the grid, the last axis fastest
counted_outcome | counted_outcome | | | outcome of a random start
outcome_count | cell counted_outcome | | | number of random starts with the outcome
quiet_count | cell | | | number of random starts that lead to the quiet orbit, which has period 1
  and touches each wall once in a cycle, symmetrically
best_clearance | mass_ratio frequency restitution | | d0 | clearance of the grid at which the
  largest motion that starts lead to is smallest
# one-third subharmonic
free_subharmonic | frequency | displacement | max |Z1| | largest displacement of the subharmonic
  without the damper
damped_subharmonic | frequency | displacement | max |Z1| | largest displacement of any subharmonic
  with the damper
subharmonic_ratio | frequency | | | damped_subharmonic divided by free_subharmonic, 0 if the
  damper removes it
suppression | frequency | | | effect of the damper on the subharmonic, judged by all motions found
  : SUPPRESSION
switched_motion | switched_motion | | | kind of motion that follows when the damper is switched on
switched_share | frequency switched_motion | | | share of starts on the free subharmonic that lead
  to each motion when the damper is switched on
    """,
    BALANCE_VERDICT=BALANCE_VERDICT,
    HIGH_VERDICT=HIGH_VERDICT,
    MINIMUM=MINIMUM,
    OUTCOME=OUTCOME,
    QUIET_VERDICT=QUIET_VERDICT,
    RUN_MOTION=RUN_MOTION,
    SEARCH=SEARCH,
    STABILITY=STABILITY,
    SUPPRESSION=SUPPRESSION,
)
