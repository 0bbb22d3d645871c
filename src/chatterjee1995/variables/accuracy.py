"""Error and work of integrators and models on test cases (scenes), one run for each setting."""

from impact_damper.data.variables import register

register(
    """
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
    """,
)
