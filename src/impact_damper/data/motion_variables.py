"""Variables of motions, harmonic balance, orbits, basins and migration control."""

from impact_damper.data.variables import VARIABLES, register

register(
    """
# coordinates
frequency | frequency | frequency | Omega | forcing frequency
clearance | clearance | clearance | d0 | clearance of the loose mass
mass_ratio | mass_ratio | | r_m | mass ratio
restitution | restitution | | e | coefficient of restitution
contact_stiffness | contact_stiffness | stiffness | r1 | stiffness of the contact
time | time | time | T | time
# state
displacement | time | displacement | Z1 | displacement of the primary mass
velocity | time | velocity | Z1' | velocity of the primary mass
relative_displacement | time | displacement | Z2 | displacement relative to the loose mass
relative_velocity | time | velocity | Z2' | velocity relative to the loose mass
# motions
component | component | | | component of the state
state | component | state | | state of the motion at the phase Omega T = pi/2
state_phase | | angle | | phase Omega T at which states are given
contact_wall | contact | | | wall of a contact, -1 or 1
contact_begin | contact | time | | beginning of a contact
contact_end | contact | time | | end of a contact
approach_velocity | contact | velocity | Z2' | relative velocity at the beginning of a contact
escape_time | | time | T | time of the first sample beyond a barrier, or NaN
departure_velocity | contact | velocity | Z2' | relative velocity at the end of a contact
contact_force | contact | force | | largest force in a contact
largest_contact_force | | force | | largest force of all contacts
absolute_displacement | time | displacement | | displacement of the primary mass on a moving base
absolute_acceleration | time | acceleration | | acceleration of the primary mass on a moving base
outcome | frequency motion | | | outcome of the motion
  # unresolved: the run ended before the outcome was certain
  # settled: on a stable periodic orbit, with contacts or without a damper
  # diverged: the state is no longer finite
  # non_colliding: settled, and the loose mass touches no wall
  # escaped: over the barrier of a softening spring
  # at_rest: a motion without forcing has come to rest
  # drifting: the primary mass is on an orbit; the loose mass drifts and touched no wall so far
  : absent -1, unresolved 0, settled 1, chaotic 2, diverged 3, non_colliding 4, escaped 5,
  : at_rest 6, quasi_periodic 7, drifting 8
period | frequency motion | | n | period of the motion in cycles
contacts | frequency motion | | | contacts begun per cycle
maximum_displacement | frequency motion | displacement | max |Z1| | largest displacement
asymmetry | frequency motion | mixed | | distance from the mirror image half a period later
phase_relative | frequency motion | angle | | phase of Z1 minus phase of Z2, if on an orbit
phase_loose | frequency motion | angle | | phase of Z1 minus phase of Z1 - Z2, if on an orbit
multiplier_real | frequency motion | | | dominant Floquet multiplier, real part
multiplier_imaginary | frequency motion | | | dominant Floquet multiplier, imaginary part
residual | frequency motion | mixed | | distance between the state and the state a period later
lyapunov_exponent | frequency motion | rate | | largest Lyapunov exponent per unit time
lyapunov_error | frequency motion | rate | | standard error of the largest Lyapunov exponent
first_frequency | frequency motion | frequency | | first frequency of a quasi-periodic motion
second_frequency | frequency motion | frequency | | second frequency of a quasi-periodic motion
frequency_error | frequency motion | frequency | | difference of the second frequency between the
  halves of the run
periods_run | frequency motion | | | cycles run before the motion settled
# frequency responses
branch | frequency motion | | | number of the branch of a motion over the sweep
motion_starts | frequency motion | | | number of random starts that lead to the motion
share_lower | frequency motion | | | share of random starts, lower end of its 95 % interval
share_upper | frequency motion | | | share of random starts, upper end of its 95 % interval
origin | frequency motion | | | how the motion was first found
  : absent 0, random_start 1, followed 2, placed_start 3
run_outcome | frequency start | | | outcome of a random start
  : outcome
run_motion | frequency start | | | index along `motion` of the motion that a start leads to
run_length | frequency start | | | cycles run from a random start
end_value | end | followed | | parameter of the sweep at the end of a branch
end_branch | end | | | branch that ends
end_direction | end | | | direction of the sweep in which the branch ends
  : down -1, up 1
end_event | end | | | event that ends the branch
  : not_smooth 0, fold 1, symmetry_breaking 2, period_doubling 3, neimark_sacker 4
end_displacement | end | displacement | | largest displacement at the end of a branch
# lives of chaotic motions
life_ends | frequency motion | | | runs of the chaotic motion that ended; -1 without runs
mean_life | frequency motion | | | mean life of the chaotic motion in cycles
mean_life_lower | frequency motion | | | mean life, lower end of its 95 % interval, cycles
mean_life_upper | frequency motion | | | mean life, upper end of its 95 % interval, cycles
# range of the random starts
start_displacement | frequency | displacement | |Z1| | largest displacement of a random start
start_speed | frequency | velocity | |Z1'| | largest speed of a random start
free_displacement | frequency | displacement | max |Z1| | largest displacement of the free motions
free_speed | frequency | velocity | max |Z1'| | largest speed of the free motions
missed_share | | | | upper bound, at 95 %, on the share of starts that lead to a motion not found
# harmonic balance
amplitude | frequency solution | displacement | a | amplitude of Z1, negative in antiphase to Z2
relative_amplitude | frequency solution | displacement | b | amplitude of Z2
phase | frequency solution | angle | theta_1 | phase of Z1 to the forcing
kind | frequency solution | | | whether the loose mass touches the walls
  : absent 0, impacting 1, resting 2
growth_rate | frequency solution | rate | | largest real part of the eigenvalues of the slow flow
stability | frequency solution | | | stability by the slow flow
  : absent -2, unstable -1, marginal 0, stable 1
balance_status | frequency | | | how the solution of the harmonic balance ended
  : solved 0, unresolved 1
free_amplitude | frequency free_solution | displacement | a | amplitude of Z1 without the damper
free_phase | frequency free_solution | angle | theta_1 | phase of Z1 without the damper
free_stability | frequency free_solution | | | stability by the slow flow without the damper
  : stability
rigid_amplitude | frequency root | displacement | a | signed amplitude of Z1 for rigid walls
rigid_wall | frequency root | | | whether rigid walls push the loose mass, or would have to pull it
  : absent 0, pushes 1, pulls 2
# suppression band
peak_frequency | | frequency | Omega_p | peak frequency without the damper
peak_amplitude | | displacement | | amplitude of Z1 without the damper at the peak frequency
quiet_amplitude | | displacement | | amplitude |a| of the quiet motion at the peak frequency
reduction | | | | 1 - |a|/(amplitude without the damper) at the peak frequency
band_status | | | | whether there is a suppression band at the peak frequency
  : found 0, no_single_motion 1, no_reduction 2, no_peak 3
edge | edge | | | lower or upper end of a range
edge_frequency | edge | frequency | | edge of the suppression band
band_width | | frequency | Delta Omega_s | width of the suppression band
# optimum clearance
quiet_displacement | clearance | displacement | max |Z1| | largest displacement in the quiet
  motion
quiet_status | clearance | | | whether there is a quiet motion
  : absent 0, found 1
largest_displacement | clearance | displacement | | largest displacement that starts lead to
analytical_amplitude | clearance | displacement | |a| | smallest stable |a| by (7)
analytical_status | clearance | | | whether the harmonic balance (7) has a stable solution
  : absent 0, found 1, inelastic 2, unresolved 3, unknown 4
optimum_clearance | | clearance | d0 | clearance at which the quiet motion is smallest
optimum_displacement | | displacement | max |Z1| | smallest quiet_displacement
optimum_kind | | | | kind of minimum: smooth, kink, end of the branch or of the sweep
  : not_found 0, smooth 1, kink 2, jump 3, edge 4
near_clearance | edge | clearance | | clearances with at most 1.1 times the smallest displacement
analytical_optimum | | clearance | d0 | clearance at which (7) has a solution with a = 0
rule_clearance | | clearance | d0 | clearance of rule (18) at the forcing frequency
peak_rule_clearance | | clearance | d0 | clearance of rule (19)
optimum_ratio | | | | rm W^2 d0/f at the optimum clearance, which is 1 by rule (18)
straight_flight_ratio | | | | rm W^2 d0/f of the optimum for rigid walls at high frequency
# orbits along branches
followed_value | point | followed | | parameter that is varied along a branch of orbits
orbit_branch | point | | | number of the branch an orbit lies on
orbit_displacement | point | displacement | max |Z1| | largest displacement in an orbit
orbit_stability | point | | | whether all Floquet multipliers are less than 1 in modulus
  : stability
orbit_status | point | | | whether Newton's method converged, or a contact is near grazing
  : not_converged 0, regular 1, near_grazing 2
orbit_contacts | point | | | contacts begun per cycle in an orbit
orbit_asymmetry | point | mixed | | distance of an orbit from its mirror image half a period later
orbit_amplitude | point | displacement | | amplitude of the first harmonic of Z1 in an orbit
orbit_phase_relative | point | angle | | phase of Z1 to Z2 in an orbit, first harmonics
orbit_phase_loose | point | angle | | phase of Z1 to Z1 - Z2 in an orbit, first harmonics
orbit_phase | point | angle | | phase Omega T of orbit_state
orbit_state | point component | state | | state of an orbit at orbit_phase, without contact
orbit_residual | point | mixed | | distance from the state a period later
orbit_multiplier_real | point multiplier | | | Floquet multipliers by modulus, real part
orbit_multiplier_imaginary | point multiplier | | | Floquet multipliers by modulus, imaginary part
liouville_error | point | | | relative error of the determinant of the monodromy matrix
least_speed | point | velocity | | smallest relative speed at the beginning of a contact
orbit_restitution | point | | | smallest ratio of the relative speeds after and before a contact
# branches
branch_period | branch | | n | period in cycles of the orbits
branch_events_lost | branch | | | number of events on a branch that were not located
branch_end | branch edge | | | event or limit that ends a branch
  : range_ends 0, closed 1, symmetry_breaking 2, period_doubling 3, contact_lost 4, lost 5,
  : point_limit 6, unstable 7
branch_met | branch edge | | | branch of more symmetry at which a branch ends, or -1
seeds | | | | number of motions from which Newton's method searched for an orbit
seeds_lost | | | | number of motions from which Newton's method converged to no orbit
# events
event_branch | event | | | branch on which an event lies
event_place | event | | | index along the branch of the orbit at an event
event_kind | event | | | kind of event
  : fold 1, symmetry_breaking 2, period_doubling 3, neimark_sacker 4, grazing 5, merging 6
event_value | event | followed | | varied parameter at an event
event_displacement | event | displacement | max |Z1| | largest displacement at an event
event_speed | event | velocity | | smallest relative speed at the beginning of a contact
walls_before | event | | | walls in the order in which orbits before an event touch them
walls_after | event | | | walls in the order in which orbits after an event touch them
# basins of attraction
basin_displacement | basin_displacement | displacement | Z1 | initial displacement of the primary
  mass
basin_velocity | basin_velocity | velocity | Z1' | initial velocity of the primary mass
basin_phase | | angle | | initial phase Omega T of the forcing
basin_label | basin_velocity basin_displacement | | | attractor to which a state leads, or a
  negative number: -1 unresolved, -2 escaped, -3 chaotic, -4 without contact, -5 depends on the
  place of the loose mass, -6 quasi-periodic
basin_share | attractor basin_velocity basin_displacement | | | fraction of the places of the
  loose mass from which a state leads to an attractor
attractor | attractor | | | index of an attractor, by rising max |Z1|
attractor_period | attractor | | n | period in cycles
attractor_displacement | attractor | displacement | max |Z1| | largest displacement
basin_time | basin_velocity basin_displacement | | | convergence time: cycles until a motion is
  known to lead to its attractor, the longest of the places of the loose mass; -1 without one
attractor_share | attractor | | | share of the states that lead to an attractor
attractor_time | attractor | | | median convergence time, cycles
attractor_within | attractor | | | finite-time basin stability: share of the states that lead to an
  attractor within a given time
attractor_shock | attractor | impulse | | minimal critical shock: smallest impulse on the primary
  mass after which a motion leaves the attractor
attractor_return | attractor | | | convergence time after a given impulse, cycles
attractor_point | attractor passage | displacement | Z1 | displacement at the phase of the plane
attractor_speed | attractor passage | velocity | Z1' | velocity at the phase of the plane
saddle_period | saddle | | n | period of an unstable orbit in cycles
saddle_displacement | saddle | displacement | Z1 | displacement of an unstable orbit in the plane
saddle_velocity | saddle | velocity | Z1' | velocity of an unstable orbit in the plane
saddle_curve | saddle | | | whether the stable manifold is complete in the plane
  : complete 0, cut 1
boundary_displacement | boundary | displacement | Z1 | displacement on a manifold; NaN at gaps
boundary_velocity | boundary | velocity | Z1' | velocity on a manifold; NaN at gaps
boundary_saddle | boundary | | | index of the unstable orbit
# migration control
on_time | trial switching | time | T | time at which the damper is switched on
off_time | trial switching | time | T | time at which the damper is switched off
end_time | trial switching | time | T | time at which the free motion has settled
released_from | trial switching | | | damped motion in which the damper is switched off
  # quiet: of period 1, smaller than half the motion at resonance without the damper; else violent
  : none -1, unsettled 0, quiet 1, violent 2, subharmonic 3
destination | trial switching | | | free motion to which a release leads
  : none -1, unresolved 0, non_resonance 1, resonance 2, subharmonic 3, other 4
trial_outcome | trial | | | whether a run arrives on the non-resonance branch
  : not_reached 0, reached 1
switchings | trial | | | number of times that the damper is switched on in a run
damper_time | trial | | | cycles with the damper on
total_time | trial | | | cycles from first switching the damper on to the end of the last free run
    """
)

OUTCOME, DAMPED_MOTION, FREE_MOTION = (
    VARIABLES[name].flags for name in ("outcome", "released_from", "destination")
)
