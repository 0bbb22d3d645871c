"""The contact model in closed form, contacts of simulated motions, and the rigid limit."""

from impact_damper.data.variables import register

register(
    """
exit_rule | exit_rule | | | rule for the end of a contact
load | load | | g/(omega_n v0) | load in contact
realised_restitution | exit_rule load restitution | | | departure speed divided by approach speed
contact_verdict | exit_rule load restitution | | | realised restitution: within 1 % of e, within 5
  %, or farther; or none, because the loose mass falls back or the contact does not end
  : close 0, fair 1, off 2, falls_back 3, no_release 4
used | used | | e | coefficient of restitution of a damper
unloaded_damping | used | | z | damping ratio of the relative motion
unloaded_restitution | exit_rule used | | | realised restitution without load
unloaded_duration | exit_rule used | | | time in contact / time in an elastic contact, without
  load
unloaded_pull_time | used | | | fraction of the time in contact in which the force is tensile
unloaded_pull_impulse | used | | | ratio of tensile to compressive impulse without load
unloaded_pull_peak | used | | | ratio of the largest tensile to the largest compressive force
  without load
size | size | | | smallest settled or largest motion to which random starts lead
contact_used | contact | | | index along the dimension `used` of a contact
contact_size | contact | | | index along the dimension `size` of a contact
contact_load | contact | | | load at the beginning of a contact
# rigid limit
stiffness | stiffness | | r1 | contact stiffness
compliant_status | frequency stiffness | | | how the search for the compliant orbit ended
  : found 0, not_followed 1, other_contacts 2, not_attempted 3
rigid_status | frequency | | | how the search for the rigid orbit ended
  : found 0, not_followed 1, other_contacts 2, not_attempted 3, chatter 4
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
own_decay_error | | | | error of the modulus of the dominant multiplier with rigid walls, for the
  damper's r1
    """,
)
