"""The one-third subharmonic without and with a damper."""

from impact_damper.data.variables.variable import SUBHARMONIC_END, SUPPRESSION, Variable

VARIABLES = {
    # one-third subharmonic
    "free_subharmonic": Variable(
        ("frequency",),
        "largest displacement of the subharmonic without the damper",
        "max |Z1|",
        quantity="displacement",
    ),
    "free_subharmonic_frequency": Variable(
        ("edge",),
        "ends of the frequency range of the subharmonic without the damper",
        quantity="frequency",
    ),
    "free_subharmonic_event": Variable(
        ("edge",), "event that ends the subharmonic without the damper", flags=SUBHARMONIC_END
    ),
    "damped_subharmonic": Variable(
        ("frequency",),
        "largest displacement of any subharmonic with the damper",
        "max |Z1|",
        quantity="displacement",
    ),
    "damped_subharmonic_period": Variable(
        ("frequency",), "period of damped_subharmonic in cycles, 0 if there is none", "n"
    ),
    "damped_subharmonic_contacts": Variable(
        ("frequency",), "contacts begun per cycle in damped_subharmonic"
    ),
    "reached_subharmonic": Variable(
        ("frequency",),
        "largest displacement of the damped subharmonics to which random starts lead",
        quantity="displacement",
    ),
    "subharmonic_ratio": Variable(
        ("frequency",), "damped_subharmonic divided by free_subharmonic, 0 if the damper removes it"
    ),
    "suppression": Variable(
        ("frequency",),
        "effect of the damper on the subharmonic, judged by all motions found",
        flags=SUPPRESSION,
    ),
    "reached_suppression": Variable(
        ("frequency",),
        "effect of the damper on the subharmonic, judged by motions to which random starts lead",
        flags=SUPPRESSION,
    ),
    "switched_motion": Variable(
        ("switched_motion",), "kind of motion that follows when the damper is switched on"
    ),
    "switched_share": Variable(
        ("frequency", "switched_motion"),
        "share of starts on the free subharmonic that lead to each motion when the damper is "
        "switched on",
    ),
    "subharmonic_branch": Variable(("subharmonic",), "number of a branch of damped subharmonics"),
    "subharmonic_period": Variable(("subharmonic",), "period of the branch in cycles", "n"),
    "subharmonic_displacement": Variable(
        ("subharmonic",),
        "largest displacement of the primary mass on the branch",
        "max |Z1|",
        quantity="displacement",
    ),
    "subharmonic_frequency": Variable(
        ("subharmonic", "edge"), "ends of the frequency range of the branch", quantity="frequency"
    ),
    "subharmonic_event": Variable(
        ("subharmonic", "edge"), "event that ends the branch", flags=SUBHARMONIC_END
    ),
}
