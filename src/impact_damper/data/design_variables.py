"""Variables of machines and of the design of a damper."""

from impact_damper.data.variables import STABILITY, register

# Why a quiet orbit ceases to be stable.
ENDS = {
    "no_orbit": -1,
    "fold": 0,
    "symmetry_breaking": 1,
    "neimark_sacker": 2,
    "branch_ends": 3,
    "range_ends": 4,
}

register(
    """
# without the damper
bare_frequency | bare_point | frequency | | frequency of an orbit without the damper
bare_displacement | bare_point | displacement | | largest displacement without the damper
bare_stability | bare_point | | | stability of an orbit without the damper
  : STABILITY
bare_branch | bare_point | | | branch of an orbit without the damper
# transients
direction | direction | | | direction in which the forcing frequency is swept
equipment | equipment | | | whether the machine has its damper
# tuned absorbers
competitor | competitor | | | absorber in place of an impact damper, or none
detuning | detuning | | | fraction by which the absorber's springs are stiffer than designed
force_share | force_share | | | factor of the machine's excitation
competitor_displacement | competitor detuning frequency force_share | displacement | | largest
  displacement of the machine
competitor_status | competitor | | | whether the displacements are exact, for a linear machine, or
  the balance of one harmonic
  : not_possible -1, exact 0, one_harmonic 1
absorber_stiffness | competitor detuning | stiffness | | stiffness of the absorber's spring
absorber_damping | competitor detuning | damping | | coefficient of the absorber's dashpot
# screening
orbit_limit | | displacement | | provisional quiet limit
balance_displacement | frequency | displacement | | largest displacement without damper by
  harmonic balance
displacement_limit | | displacement | | quiet limit: largest displacement of a quiet motion
screened_gap | screened | displacement | | gap of a quiet orbit
screened_displacement | screened frequency | displacement | | largest displacement of the quiet
  orbit
screened_modulus | screened frequency | | | modulus of the largest multiplier of the quiet orbit
  over half a period
best_orbit_frequency | | frequency | | frequency at which the machine alone moves most, among
  those with a stable quiet orbit
best_orbit_gap | | displacement | | gap of the smallest stable quiet orbit, the best orbit, at
  best_orbit_frequency
best_orbit_displacement | | displacement | | largest displacement of the best orbit
best_orbit_status | | | | how the best orbit was found
  : absent 0, smooth 1, kink 2, stability_ends 3, range_ends 4, not_refined 5
screen_motions | | | | number of motions that the screening ran
screen_orbits | | | | number of exact orbits that the screening computed
# comparison of gaps
coarse_gap | coarse | displacement | | gap of the coarse comparison
coarse_displacement | coarse | displacement | | largest displacement over the band
coarse_share | coarse | | | share of starts that lead to quiet motions, at the worst frequency of
  the band
candidate_gap | candidate | displacement | | gap of a candidate
start_count | candidate frequency | | | number of random starts; smaller where few starts show
  that the gap is not quiet
start_quiet_share | candidate frequency | | | share of random starts that lead to quiet motions
start_quiet_interval | candidate frequency side | | | 95 % interval of start_quiet_share
worst_displacement | candidate frequency | displacement | | largest displacement of all motions
  that starts lead to
quiet_time_median | candidate frequency | | | median of the cycles in which quiet motions settle
quiet_time_late | candidate frequency | | | cycles in which 95 % of the quiet motions settle
design_gap | | displacement | | gap chosen, the full play
design_choice | | | | why the gap design_gap was chosen
  : robust 0, needs_tolerance 1, least_worst 2
tried_restitution | tried | | | restitution that was tried, where it is free within a range
tried_gap | tried | displacement | | best gap with this restitution
tried_displacement | tried | displacement | | largest displacement with this restitution over
  band, starts and tolerated gaps
tried_choice | tried | | | why the gap tried_gap was chosen
  : robust 0, needs_tolerance 1, least_worst 2
compared_motions | | | | number of motions that the comparison of gaps ran
# cliff
side | side | | | lower or upper end
cliff_gap | side | displacement | | last quiet gap
cliff_beyond | side | displacement | | first gap that is not quiet
cliff_status | side | | | how the end of the quiet gaps was found
  : found 0, range_ends 1, no_quiet_gap 2
cliff_frequency | side | frequency | | frequency at which quiet gaps end first
life_gap | life | displacement | | gap at which the lives of violent motions were observed
life_rate | life bound | | | rate at which violent motions become quiet, per cycle
branch_frequency | | frequency | | frequency at which the quiet orbit is followed
gap_of_orbit | gap_point | displacement | | gap of an orbit
displacement_by_gap | gap_point | displacement | | largest displacement of the orbit at
  gap_of_orbit
modulus_by_gap | gap_point | | | modulus of the largest multiplier of the orbit at gap_of_orbit
stability_gap | side | displacement | | gap at which the quiet orbit ceases to be stable
stability_gap_event | side | | | why the quiet orbit ceases to be stable at stability_gap
  : ENDS
changed | changed | | | parameter that grows by 1 per cent
displacement_change | changed | | | change of the largest displacement of the quiet orbit, per
  cent
modulus_change | changed | | | change of the modulus of the orbit's largest multiplier, per cent
# deviations
varied | varied | | | quantity that deviates from its nominal value
sample_factor | sample varied | | | value divided by the nominal one
sample_displacement | sample | displacement | | largest displacement over the band
sample_share | sample bound | | | share of starts over the band that lead to quiet motions
corner_factor | corner varied | | | value divided by the nominal one
corner_displacement | corner | displacement | | largest displacement over the band
corner_share | corner bound | | | share of new starts that lead to quiet motions
promise | | | | promise of the design, and whether new starts confirmed it
  : none_made 0, nominal_kept 1, robust_kept 2, broken 3
map_gap | map_gap | displacement | | gap of a cell of the map
map_restitution | map_restitution | | | restitution of a cell of the map
operating_frequency | operating_frequency | frequency | | frequency of a cell of the map
damper_map_share | map_gap map_restitution | | | share of starts that lead to quiet motions
damper_map_displacement | map_gap map_restitution | displacement | | largest displacement
force_map_share | operating_frequency force_share | | | share of starts that lead to quiet motions
force_map_displacement | operating_frequency force_share | displacement | | largest displacement
force_map_modulus | operating_frequency force_share | | | modulus of the largest multiplier of the
  quiet orbit over half a period
damper_map_modulus | map_gap map_restitution | | | modulus of the largest multiplier of the quiet
  orbit over half a period
stability_force_by_frequency | operating_frequency side | | | multiples of the nominal force
  between which the quiet orbit is stable
# masses
other_mass | other | mass | | loose mass
other_gap | other | displacement | | gap chosen for this loose mass
other_displacement | other | displacement | | largest displacement within the tolerance of the gap
other_share | other | | | share of starts that lead to quiet motions, at the worst frequency of
  the band
other_force | other | force | | largest contact force over the band
other_best | other | | | whether no other mass is better in mass, displacement and force together
  : no 0, yes 1
# transients
sweep_envelope | direction equipment sweep_window | displacement | | largest displacement in a cycle
sweep_status | direction equipment | | | how the sweep ended
  : completed 0, escaped 1
ring_time | equipment ring_window | time | | middle of a period of the unforced vibration
ring_envelope | equipment ring_window | displacement | | largest displacement in this period
ring_status | equipment | | | how the unforced decay ended
  : escaped 1, at_rest 2, limit 3
sweep_frequency | direction sweep_window | frequency | | forcing frequency
# motions of the design
motion_rms | frequency | displacement | | r.m.s. displacement of the largest motion that starts
  lead to
motion_peak_high | frequency | displacement | | 95th percentile of the peaks of this motion
reached_displacement | frequency | displacement | | largest displacement of all motions that
  starts lead to
untouched_displacement | frequency | displacement | | largest displacement of a motion in which
  the loose mass touches no wall and to which no random start leads
reached_quiet_share | frequency | | | share of random starts that lead to quiet motions
reached_quiet_interval | frequency side | | | 95 % interval of reached_quiet_share
impact_rate_by_frequency | frequency | rate | | impacts per time
contact_force_by_frequency | frequency | force | | largest force in a contact
penetration_by_frequency | frequency | displacement | | largest penetration of a wall
impact_speed_by_frequency | frequency | velocity | | largest relative speed of an impact
impact_loss_by_frequency | frequency | energy | | mean energy lost in an impact
impact_power_by_frequency | frequency | power | | mean power lost in contacts
pressure_by_frequency | frequency | pressure | | largest pressure after Hertz
yields_by_frequency | frequency | | | whether the material yields at this pressure
  : no 0, yes 1, unknown 2
noise_by_frequency | frequency | impulse_noise | | sum of the squared impulses of impacts, per
  time
# competitors
den_hartog_stiffness | | stiffness | | stiffness of a tuned absorber by Den Hartog's closed form
den_hartog_damping | | damping | | damping of Den Hartog's absorber by Brock's closed form
    """,
    ENDS=ENDS,
    STABILITY=STABILITY,
)
