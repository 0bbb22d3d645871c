"""The one-third subharmonic without and with a damper."""

from impact_damper.data.variables import SUBHARMONIC_END, SUPPRESSION, register

register(
    """
# one-third subharmonic
free_subharmonic | frequency | displacement | max |Z1| | largest displacement of the subharmonic
  without the damper
free_subharmonic_frequency | edge | frequency | | ends of the frequency range of the subharmonic
  without the damper
free_subharmonic_event | edge | | | event that ends the subharmonic without the damper
  : SUBHARMONIC_END
damped_subharmonic | frequency | displacement | max |Z1| | largest displacement of any subharmonic
  with the damper
subharmonic_ratio | frequency | | | damped_subharmonic divided by free_subharmonic, 0 if the
  damper removes it
suppression | frequency | | | effect of the damper on the subharmonic, judged by all motions found
  : SUPPRESSION
reached_suppression | frequency | | | effect of the damper on the subharmonic, judged by motions
  to which random starts lead
  : SUPPRESSION
switched_motion | switched_motion | | | kind of motion that follows when the damper is switched on
switched_share | frequency switched_motion | | | share of starts on the free subharmonic that lead
  to each motion when the damper is switched on
subharmonic_period | subharmonic | | n | period of the branch in cycles
subharmonic_displacement | subharmonic | displacement | max |Z1| | largest displacement of the
  primary mass on the branch
subharmonic_frequency | subharmonic edge | frequency | | ends of the frequency range of the branch
subharmonic_event | subharmonic edge | | | event that ends the branch
  : SUBHARMONIC_END
    """,
    SUBHARMONIC_END=SUBHARMONIC_END,
    SUPPRESSION=SUPPRESSION,
)
