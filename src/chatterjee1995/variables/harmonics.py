"""Harmonic balance with many harmonics and Hill's method, compared with the exact orbit."""

from impact_damper.data.variables import register

SEARCH = {"converged": 0, "stalled": 1, "iteration_limit": 2}

register(
    """
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
    """,
    SEARCH=SEARCH,
)
