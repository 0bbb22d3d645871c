"""Failures of integrators: contacts missed near grazing, and the largest stable steps."""

from impact_damper.data.variables import register

register(
    """
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
    """,
)
