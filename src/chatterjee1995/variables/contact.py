"""The contact model in closed form, contacts of simulated motions, and the rigid limit.

The load g/(omega_n v0) is the relative acceleration g that all forces except the force of the wall
cause, made dimensionless with the natural frequency omega_n of the contact and the approach speed
v0. The realised restitution is the ratio of departure to approach speed (`contact.contact_law`). A
"mended" rigid orbit is an orbit between corrected rigid walls
(`contact.rigid_orbits.mended_walls`).
"""

from impact_damper.data.variables import OUTCOME, register

SCENE = ("used", "frequency", "size")
FOLLOWED = {"found": 0, "not_followed": 1, "other_contacts": 2, "not_attempted": 3}
RIGID = FOLLOWED | {"chatter": 4}

register(
    """
# map
exit_rule | exit_rule | | | rule for the end of a contact
load | load | | g/(omega_n v0) | load in contact
realised_restitution | exit_rule load restitution | | | departure speed divided by approach speed
contact_duration | exit_rule load restitution | | | time in contact / time in an elastic contact
contact_verdict | exit_rule load restitution | | | realised restitution: within 1 % of e, within 5
  %, or farther; or none, because the loose mass falls back or the contact does not end
  : close 0, fair 1, off 2, falls_back 3, no_release 4
pull_impulse | load restitution | | | ratio of tensile to compressive impulse of the wall
pull_peak | load restitution | | | ratio of the largest tensile to the largest compressive force
  of the wall
# without load
used | used | | e | coefficient of restitution of a damper
unloaded_damping | used | | z | damping ratio of the relative motion
unloaded_restitution | exit_rule used | | | realised restitution without load
unloaded_duration | exit_rule used | | | time in contact / time in an elastic contact, without
  load
unloaded_pull_time | used | | | fraction of the time in contact in which the force is tensile
unloaded_pull_impulse | used | | | ratio of tensile to compressive impulse without load
unloaded_pull_peak | used | | | ratio of the largest tensile to the largest compressive force
  without load
# contacts of motions
size | size | | | smallest settled or largest motion to which random starts lead
scene_outcome | used frequency size | | | outcome of the motion
  : OUTCOME
scene_displacement | used frequency size | | max |Z1| | largest displacement of the motion
scene_without_pull | used frequency size | | max |Z1| | largest displacement if contacts realise
  the restitution of walls that cannot pull
scene_without_pull_status | used frequency size | | | whether the motion with walls that cannot
  pull was found
  : absent -1, found 0, not_settled 1, not_followed 2, other_contacts 3
scene_contacts | used frequency size | | | number of contacts logged
scene_load | used frequency size | | | 99 % quantile of |load| over the contacts
scene_close | used frequency size | | | fraction of contacts with a restitution within 1 % of e
scene_fair | used frequency size | | | fraction of contacts with a restitution within 5 % of e
scene_restitution_low | used frequency size | | | smallest restitution of a contact
scene_restitution_high | used frequency size | | | largest restitution of a contact
scene_unreleased | used frequency size | | | number of contacts that would not end under a
  constant load, by the closed form
scene_restitution_error | used frequency size | | | 99 % quantile over the contacts of the error
  of the closed-form restitution
scene_duration_error | used frequency size | | | 99 % quantile over the contacts of the error of
  the closed-form time in contact
contact_used | contact | | | index along the dimension `used` of a contact
contact_row | contact | | | index along the dimension `frequency` of a contact
contact_size | contact | | | index along the dimension `size` of a contact
contact_load | contact | | | load at the beginning of a contact
contact_restitution | contact | | | departure speed divided by approach speed
contact_time | contact | | | time in contact / time in an elastic contact
# rigid limit
stiffness | stiffness | | r1 | contact stiffness
compliant_status | frequency stiffness | | | how the search for the compliant orbit ended
  : FOLLOWED
compliant_displacement | frequency stiffness | | max |Z1| | largest displacement of the compliant
  orbit
compliant_multiplier_real | frequency stiffness | | | dominant Floquet multiplier, real part
compliant_multiplier_imaginary | frequency stiffness | | | dominant Floquet multiplier, imaginary
  part
rigid_status | frequency | | | how the search for the rigid orbit ended
  : RIGID
rigid_displacement | frequency | | max |Z1| | largest displacement of the rigid orbit
rigid_multiplier_real | frequency | | | dominant Floquet multiplier, real part
rigid_multiplier_imaginary | frequency | | | dominant Floquet multiplier, imaginary part
mended_status | frequency stiffness | | | how the search for the orbit between corrected rigid
  walls ended
  : RIGID
mended_displacement | frequency stiffness | | max |Z1| | largest displacement of the orbit between
  corrected rigid walls
mended_multiplier_real | frequency stiffness | | | dominant Floquet multiplier, real part
mended_multiplier_imaginary | frequency stiffness | | | dominant Floquet multiplier, imaginary
  part
rigid_error | frequency stiffness | | | relative error of max |Z1| if walls are taken as rigid
mended_error | frequency stiffness | | | relative error of max |Z1| with corrected rigid walls
decay_error | frequency stiffness | | | error of the modulus of the dominant multiplier if walls
  are taken as rigid
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
own_decay_error | | | | error of the modulus of the dominant multiplier with rigid walls, for the
  damper's r1
    """,
    FOLLOWED=FOLLOWED,
    OUTCOME=OUTCOME,
    RIGID=RIGID,
)
