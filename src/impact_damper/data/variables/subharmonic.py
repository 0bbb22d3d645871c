"""The one-third subharmonic without and with a damper."""

from impact_damper.data.variables.variable import SUBHARMONIC_END, SUPPRESSION, Variable

VARIABLES = {
    # one-third subharmonic
    "free_subharmonic": Variable(
        ("frequency",), "largest displacement of the subharmonic without the damper", "max |Z1|"
    ),
    "free_subharmonic_frequency": Variable(("edge",), "ends of the subharmonic without the damper"),
    "free_subharmonic_event": Variable(("edge",), "what ends it", flags=SUBHARMONIC_END),
    "damped_subharmonic": Variable(
        ("frequency",), "largest displacement of any subharmonic with the damper", "max |Z1|"
    ),
    "damped_subharmonic_period": Variable(
        ("frequency",), "its period in forcing periods, 0 without", "n"
    ),
    "damped_subharmonic_contacts": Variable(
        ("frequency",), "its contacts begun per forcing period"
    ),
    "reached_subharmonic": Variable(
        ("frequency",), "largest displacement of the damped subharmonics that starts lead to"
    ),
    "subharmonic_ratio": Variable(
        ("frequency",), "damped_subharmonic over free_subharmonic, 0 if removed"
    ),
    "suppression": Variable(
        ("frequency",),
        "what the damper makes of the subharmonic, by all motions found",
        flags=SUPPRESSION,
    ),
    "reached_suppression": Variable(
        ("frequency",),
        "what the damper makes of the subharmonic, by motions that starts lead to",
        flags=SUPPRESSION,
    ),
    "switched_motion": Variable(
        ("switched_motion",), "kind of motion after the damper was switched on"
    ),
    "switched_share": Variable(
        ("frequency", "switched_motion"),
        "share of the runs in which the damper was switched on to the free subharmonic",
    ),
    "subharmonic_branch": Variable(("subharmonic",), "number of a branch of damped subharmonics"),
    "subharmonic_period": Variable(("subharmonic",), "its period in forcing periods", "n"),
    "subharmonic_displacement": Variable(
        ("subharmonic",), "its largest displacement of the primary mass", "max |Z1|"
    ),
    "subharmonic_frequency": Variable(("subharmonic", "edge"), "ends of its range of frequencies"),
    "subharmonic_event": Variable(("subharmonic", "edge"), "what ends it", flags=SUBHARMONIC_END),
}
