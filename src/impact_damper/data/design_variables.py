"""Variables of machines and of the design of a damper."""

from impact_damper.data.variables import register

# A gap is "lost" if the search found there a displacement above KEEPS x the promised displacement.
# A damper is worth building if it lowers the largest displacement by the fraction WORTH or more.
KEEPS, WORTH = 1.1, 0.25

register(
    """
# transients
direction | direction | | | direction in which the forcing frequency is swept
equipment | equipment | | | whether the machine has its damper
# tuned absorbers
competitor | competitor | | | absorber in place of an impact damper, or none
detuning | detuning | | | fraction by which the absorber's springs are stiffer than designed
force_share | force_share | | | factor of the machine's excitation
competitor_displacement | competitor detuning frequency force_share | displacement | | largest
  displacement of the machine
competitor_status | competitor | | | whether the displacements are exact (linear) or of one harmonic
  : not_possible -1, exact 0, one_harmonic 1
absorber_stiffness | competitor detuning | stiffness | | stiffness of the absorber's spring
absorber_damping | competitor detuning | damping | | coefficient of the absorber's dashpot
# decision
design_gap | | displacement | | gap of the damper, the full play
decision | | | | whether the damper takes at least a quarter off the largest displacement
  : build 0, do_not_build 1
displacement_limit | | displacement | | displacement with which the promised one is compared
limit_status | | | | whether the promised displacement is at most the limit
  : none 0, met 1, missed 2
promised_displacement | | displacement | | displacement below which the machine stays from a share
  of the starts, for the worst frequency and the worst values within the tolerances
promised_frequency | | frequency | | frequency of the promised displacement
promised_set | | | | index of the factors, in promise_factor, of the promised displacement
promised_share | | | | share of the starts for which the displacement is promised
promise_starts | | | | number of new starts at each frequency and set of factors
promise_rank | | | | rank, from the largest, of the start whose displacement is the bound
gap_promised_displacement | | displacement | | promised displacement if the gap alone deviates
confirmation | | | | whether the promise exceeds the least of the search by at most 5 per cent
  : confirmed 0, rounds_ended 1, given 2
peak_status | | | | whether the peak between frequencies is known to 1 %
  : known 0, not_known 1
record_status | | | | whether motions that do not settle exceeded their extrapolation to the end
  : known 0, still_grows 1
largest_bare_displacement | | displacement | | largest displacement without damper over the band
largest_bare_frequency | | frequency | | frequency of the largest displacement without damper
tuned_displacement | | displacement | | largest displacement with a tuned absorber of this mass
detuned_displacement | | displacement | | largest displacement if its stiffness is 10 % off
own_absorber_displacement | | displacement | | largest displacement with the absorber given
least_ratio | | | | least displacement with the damper divided by the one without it, over the band
worst_ratio | | | | greatest displacement with the damper divided by the one without it
worst_ratio_frequency | | frequency | | frequency of worst_ratio
side | side | | | lower or upper end
lost_gap | side | displacement | | nearest gap outside the tolerance at which the search found a
  displacement more than 10 % above the promised one
lost_displacement | side | displacement | | displacement that the search found at this gap
lost_kind | side | | | whether the displacement jumps there (the cliff)
  : jump 0, growth 1, none 2
range_gap | gap_range side | displacement | | ends of a range of gaps that the search found nearly
  as good as the best gap
range_displacement | gap_range | displacement | | least displacement within the tolerance there
best_orbit_gap | | displacement | | gap of the smallest stable quiet orbit at branch_frequency
best_orbit_displacement | | displacement | | largest displacement of this orbit
best_orbit_beyond | | | | whether its gap lies beyond the cliff, if lost_gap is one
  : no 0, yes 1, no_orbit 2
# promise
varied | varied | | | quantity that deviates from its nominal value
promise_factor | factor_set varied | | | value divided by the nominal one; the first set is nominal
promise_frequency | promise_frequency | frequency | | forcing frequency of the confirmation
promise_displacement | factor_set promise_frequency | displacement | | displacement below which the
  machine stays from a share of the starts; NaN where the frequency was not run
promise_bare_displacement | promise_frequency | displacement | | largest displacement without damper
unsettled_share | promise_frequency | | | share of motions at nominal values that do not settle
settling_late | promise_frequency | | | cycles in which 95 % of the motions that settle have settled
# search
searched_gap | searched | displacement | | gap of the search
searched_displacement | searched | displacement | | displacement that about (1 - share)/2 of the
  starts exceed; for gaps that were tried the promised displacement
searched_tolerated | searched | displacement | | largest displacement within the gap tolerance
# additions
addition | addition | | | result that was computed in addition to the decision
addition_status | addition | | | whether it was computed
  : computed 0, failed 1
branch_frequency | | frequency | | frequency at which the quiet orbit is followed
gap_of_orbit | gap_point | displacement | | gap of an orbit
displacement_by_gap | gap_point | displacement | | largest displacement of the orbit
modulus_by_gap | gap_point | | | modulus of the largest multiplier of the orbit at gap_of_orbit
# maps
operating_frequency | operating_frequency | frequency | | frequency of a cell of the map
force_map_displacement | operating_frequency force_share | displacement | | displacement below
  which the machine stays from a share of the starts
# masses
other_mass | other | mass | | loose mass
other_gap | other | displacement | | gap chosen for this loose mass
other_displacement | other | displacement | | promised displacement with this loose mass
other_force | other | force | | largest contact force at the worst frequency
# transients
sweep_envelope | direction equipment sweep_window | displacement | | largest displacement in a cycle
sweep_status | direction equipment | | | how the sweep ended
  : completed 0, escaped 1
ring_time | equipment ring_window | time | | middle of a period of the unforced vibration
ring_envelope | equipment ring_window | displacement | | largest displacement in this period
ring_status | equipment | | | how the unforced decay ended
  : escaped 1, at_rest 2, limit 3
sweep_frequency | direction sweep_window | frequency | | forcing frequency
# shocks
shock_impulse | shock_impulse | impulse | | impulse on the machine
shock_return | shock_impulse | | | cycles until the machine stays below the promised displacement,
  infinite if it does not
critical_shock | | impulse | | minimal critical shock: smallest impulse after which the machine
  does not return
return_limit | return_limit | | | cycles within which a motion returns
returned_share | return_limit | | | finite-time basin stability: share of starts that return
# motions of the design
reached_displacement | frequency | displacement | | largest displacement that starts lead to
untouched_displacement | frequency | displacement | | largest displacement of a motion in which
  the loose mass touches no wall and to which no random start leads
impact_rate_by_frequency | frequency | rate | | impacts per time
contact_force_by_frequency | frequency | force | | largest force in a contact
penetration_by_frequency | frequency | displacement | | largest penetration of a wall
impact_speed_by_frequency | frequency | velocity | | largest relative speed of an impact
impact_power_by_frequency | frequency | power | | mean power lost in contacts
acceleration_by_frequency | frequency | acceleration | | largest acceleration of the machine
absolute_displacement_by_frequency | frequency | displacement | | largest displacement of the
  machine on a moving base, not relative to the base
pressure_by_frequency | frequency | pressure | | largest pressure after Hertz
yields_by_frequency | frequency | | | whether the material yields at this pressure
  : no 0, yes 1, unknown 2
# migration
released_gap | released_gap | displacement | | gap of the damper that is released, the full play
released_frequency | released_frequency | frequency | | forcing frequency of a release
migration_share | released_gap released_frequency | | | share of releases that lead to the small
  motion without damper
migration_time | released_gap released_frequency | time | | median time from switching the damper
  on to the small motion, infinite if fewer than half of the releases lead to it
migration_bound | released_gap released_frequency | time | | time within which the required share
  of all releases lead to the small motion, infinite if they are not sure to do so
migration_status | released_gap released_frequency | | | whether the required share of releases lead
  to the small motion
  : one_motion -1, not_sure 0, sure 1
sure_frequency | released_gap | frequency | | lowest frequency from which on releases are sure
migration_gap | | displacement | | gap with the lowest sure_frequency
migration_required | | | | share of releases that is required
migration_offer | | | | whether releases of the damper may help where it is not worth building
  : no 0, yes 1
    """
)
