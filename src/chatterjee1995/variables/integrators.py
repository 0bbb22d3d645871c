"""Failures of integrators: contacts missed near grazing, unstable steps, wrong verdicts.

A passage is a random flight of the loose mass, computed without walls (`rivals.passages`). As a
test case, a wall is placed close to the largest |Z2| of the flight. A scene is another test case: a
motion and an orbit, with the knowledge whether the motion settles on the orbit. The verdict on a
method says whether it finds the right answer.
"""

from impact_damper.data.variables import register

STEP_VERDICT = {
    "no_orbit": -2,
    "not_run": -1,
    "within_1_percent": 0,
    "within_10_percent": 1,
    "off": 2,
    "escaped": 3,
    "diverged": 4,
}
VERDICT = {
    "not_run": -1,
    "right": 0,
    "not_settled": 1,
    "wrong_period": 2,
    "wrong_branch": 3,
    "stays_wrongly": 4,
    "failed": 5,
}

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
spurious_count | integrator method_tolerance depth | | | number of contacts that a method reports
  in passages without contact
mean_steps | integrator method_tolerance | | | mean number of steps per cycle in flight, failed
  runs excluded
motion_error | integrator method_tolerance | | | median error of the largest |Z2| of a passage,
  failed runs excluded
passages | integrator | | | number of passages run for each tolerance
passages_drawn | | | | number of random flights among which the passages were chosen
fixed_steps | method_tolerance | | | steps per cycle of the fixed-step method
expected_unseen | method_tolerance depth | | | expected share of contacts at random times that
  begin and end within one fixed step
extremum_time | passage | | T | time of the largest |Z2| of a passage
extremum | passage | | | largest |Z2| of a passage
extremum_curvature | passage | | | |Z2''| at the largest |Z2| of a passage
# largest stable steps
fixed_method | fixed_method | | | method with equal steps
scaled_step | scaled_step | | h omega_c | step times contact frequency
accuracy | accuracy | | | relative deviation allowed in max |Z1|
step_verdict | fixed_method contact_stiffness scaled_step | | | deviation of the method from the
  quiet motion
  : STEP_VERDICT
step_deviation | fixed_method contact_stiffness scaled_step | | | largest relative deviation of
  max |Z1| in any period, infinite if the run diverged
steps_per_period | contact_stiffness scaled_step | | | steps per cycle
stable_step | fixed_method contact_stiffness accuracy | | h | largest step that keeps the accuracy
  together with all smaller ones
largest_holding_step | fixed_method contact_stiffness accuracy | | h | largest step that keeps the
  accuracy
step_slope | fixed_method accuracy | | | slope of log(1/h) as a function of log r1, h the largest
  stable step
step_slope_error | fixed_method accuracy | | | standard error of step_slope
linear_limit | fixed_method | | | largest product of step and contact frequency by linear
  stability theory
contact_frequency | contact_stiffness | | omega_c | natural frequency of an undamped contact
reference_displacement | contact_stiffness | | max |Z1| | largest displacement of the exact orbit
orbit_multiplier | contact_stiffness | | | modulus of the dominant Floquet multiplier of the exact
  orbit
free_bound | | | max |Z1| | displacement beyond which a run has escaped
# verdicts by tolerance
scene | scene | | | test case: a motion near an orbit of known stability
verdict_method | verdict_method | | | method of integration
verdict | scene verdict_method method_tolerance | | | verdict on the method: right, or the kind of
  error
  : VERDICT
right_from | scene verdict_method | | | largest tolerance, or smallest number of steps, that gives
  the right verdict together with all stricter ones
verdict_steps | method_tolerance | | | steps per cycle of fixed-step methods
scene_multiplier | scene | | | modulus of the dominant Floquet multiplier of the orbit
scene_period | scene | | n | period of the orbit in cycles
landing_period | scene | | n | period of the resulting motion, 0 if the motion does not settle
scene_periods | scene | | | number of cycles of a run
scene_frequency | scene | | Omega | forcing frequency
scene_truth | scene | | | whether the motion settles on the orbit
  : leaves 0, stays 1
    """,
    STEP_VERDICT=STEP_VERDICT,
    VERDICT=VERDICT,
)
