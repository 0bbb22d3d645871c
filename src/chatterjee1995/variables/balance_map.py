"""Harmonic balance compared with exact motions, in maps over frequency and another parameter.

A cell of a map is one frequency and one value of the other parameter; a row is one value of the
other parameter. In each cell two solutions of the harmonic balance, equation (7) of the paper, are
compared with motions. The quiet solution has the smallest amplitude |a| of the primary mass, below
half of the resonance amplitude without damper. The high solution has the largest |a|, at least this
half (`stages.balance_map`). The quiet run and the high run are simulations from these two
solutions.
"""

from impact_damper.data.variables import OUTCOME, register

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

register(
    """
map_value | map_value | | | value of the parameter that differs between the rows of a map
frequency_ratio | frequency_ratio | | Omega/Omega_p | forcing frequency over the peak frequency
map_frequency | map_value frequency_ratio | | Omega | forcing frequency
map_clearance | map_value | | d0 | clearance of the loose mass
resonance_amplitude | map_value frequency_ratio | | | amplitude of the free resonance branch;
  beyond its end, the amplitude at its end
# the quiet motion
balance_quiet | map_value frequency_ratio | | | stability of the quiet solution of harmonic
  balance by the slow flow
  : BALANCE_VERDICT
balance_quiet_amplitude | map_value frequency_ratio | | |a| | |a| of the quiet solution of
  harmonic balance
quiet_orbit | map_value frequency_ratio | | | stability of the exact quiet orbit, or the
  bifurcation by which it becomes unstable
  : unresolved -1, absent 0, stable 1, fold 2, symmetry_breaking 3, neimark_sacker 4
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
# runs from the quiet solution
quiet_run_motion | map_value frequency_ratio | | | motion to which a start at the quiet solution
  of harmonic balance leads
  : RUN_MOTION
# the high motion
balance_high | map_value frequency_ratio | | | stability of the high solution of harmonic balance
  : BALANCE_VERDICT
balance_high_amplitude | map_value frequency_ratio | | |a| | |a| of the high stable solution of
  harmonic balance
high_run_motion | map_value frequency_ratio | | | motion to which the high run leads; the run
  starts at the high solution of harmonic balance or, where none exists, on the free resonance
  branch
  : RUN_MOTION
high_run_outcome | map_value frequency_ratio | | | outcome of the high run
  : OUTCOME
high_long_outcome | map_value frequency_ratio | | | outcome of some chaotic high runs, repeated
  with ten times as many cycles
  : OUTCOME
high_verdict | map_value frequency_ratio | | | high motion: result of harmonic balance, then
  motion to which the high run leads
  : HIGH_VERDICT
    """,
    BALANCE_VERDICT=BALANCE_VERDICT,
    HIGH_VERDICT=HIGH_VERDICT,
    OUTCOME=OUTCOME,
    QUIET_VERDICT=QUIET_VERDICT,
    RUN_MOTION=RUN_MOTION,
)
