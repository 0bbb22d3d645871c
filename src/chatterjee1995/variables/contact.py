"""The contact model in closed form, contacts of simulated motions, and the rigid limit.

The load g/(omega_n v0) is the relative acceleration g that all forces except the force of the wall
cause, made dimensionless with the natural frequency omega_n of the contact and the approach speed
v0. The realised restitution is the ratio of departure to approach speed (`contact.contact_law`). A
"mended" rigid orbit is an orbit between corrected rigid walls
(`contact.rigid_orbits.mended_walls`).
"""

from impact_damper.data.variables.variable import OUTCOME, Variable

CELL = ("exit_rule", "load", "restitution")
UNLOADED = ("exit_rule", "used")
SCENE = ("used", "frequency", "size")
LIMIT = ("frequency", "stiffness")
FOLLOWED = {"found": 0, "not_followed": 1, "other_contacts": 2, "not_attempted": 3}
RIGID = FOLLOWED | {"chatter": 4}
REAL = "dominant Floquet multiplier, real part"
IMAGINARY = "dominant Floquet multiplier, imaginary part"

VARIABLES = {
    # map
    "exit_rule": Variable(("exit_rule",), "rule for the end of a contact"),
    "load": Variable(("load",), "load in contact", "g/(omega_n v0)"),
    "realised_restitution": Variable(CELL, "departure speed divided by approach speed"),
    "contact_duration": Variable(CELL, "time in contact / time in an elastic contact"),
    "contact_verdict": Variable(
        CELL,
        "realised restitution: within 1 % of e, within 5 %, or farther; or none, because the loose "
        "mass falls back or the contact does not end",
        flags={"close": 0, "fair": 1, "off": 2, "falls_back": 3, "no_release": 4},
    ),
    "pull_impulse": Variable(CELL[1:], "ratio of tensile to compressive impulse of the wall"),
    "pull_peak": Variable(
        CELL[1:], "ratio of the largest tensile to the largest compressive force of the wall"
    ),
    # without load
    "used": Variable(("used",), "coefficient of restitution of a damper", "e"),
    "unloaded_damping": Variable(("used",), "damping ratio of the relative motion", "z"),
    "unloaded_restitution": Variable(UNLOADED, "realised restitution without load"),
    "unloaded_duration": Variable(
        UNLOADED, "time in contact / time in an elastic contact, without load"
    ),
    "unloaded_pull_time": Variable(
        ("used",), "fraction of the time in contact in which the force is tensile"
    ),
    "unloaded_pull_impulse": Variable(
        ("used",), "ratio of tensile to compressive impulse without load"
    ),
    "unloaded_pull_peak": Variable(
        ("used",), "ratio of the largest tensile to the largest compressive force without load"
    ),
    # contacts of motions
    "size": Variable(("size",), "smallest settled or largest motion to which random starts lead"),
    "scene_outcome": Variable(SCENE, "outcome of the motion", flags=OUTCOME),
    "scene_displacement": Variable(SCENE, "largest displacement of the motion", "max |Z1|"),
    "scene_without_pull": Variable(
        SCENE,
        "largest displacement if contacts realise the restitution of walls that cannot pull",
        "max |Z1|",
    ),
    "scene_without_pull_status": Variable(
        SCENE,
        "whether the motion with walls that cannot pull was found",
        flags={
            "absent": -1,
            "found": 0,
            "not_settled": 1,
            "not_followed": 2,
            "other_contacts": 3,
        },
    ),
    "scene_contacts": Variable(SCENE, "number of contacts logged"),
    "scene_load": Variable(SCENE, "99 % quantile of |load| over the contacts"),
    "scene_close": Variable(SCENE, "fraction of contacts with a restitution within 1 % of e"),
    "scene_fair": Variable(SCENE, "fraction of contacts with a restitution within 5 % of e"),
    "scene_restitution_low": Variable(SCENE, "smallest restitution of a contact"),
    "scene_restitution_high": Variable(SCENE, "largest restitution of a contact"),
    "scene_unreleased": Variable(
        SCENE, "number of contacts that would not end under a constant load, by the closed form"
    ),
    "scene_restitution_error": Variable(
        SCENE, "99 % quantile over the contacts of the error of the closed-form restitution"
    ),
    "scene_duration_error": Variable(
        SCENE, "99 % quantile over the contacts of the error of the closed-form time in contact"
    ),
    "contact_used": Variable(("contact",), "index along the dimension `used` of a contact"),
    "contact_row": Variable(("contact",), "index along the dimension `frequency` of a contact"),
    "contact_size": Variable(("contact",), "index along the dimension `size` of a contact"),
    "contact_load": Variable(("contact",), "load at the beginning of a contact"),
    "contact_restitution": Variable(("contact",), "departure speed divided by approach speed"),
    "contact_time": Variable(("contact",), "time in contact / time in an elastic contact"),
    # rigid limit
    "stiffness": Variable(("stiffness",), "contact stiffness", "r1"),
    "compliant_status": Variable(
        LIMIT, "how the search for the compliant orbit ended", flags=FOLLOWED
    ),
    "compliant_displacement": Variable(
        LIMIT, "largest displacement of the compliant orbit", "max |Z1|"
    ),
    "compliant_multiplier_real": Variable(LIMIT, REAL),
    "compliant_multiplier_imaginary": Variable(LIMIT, IMAGINARY),
    "rigid_status": Variable(
        ("frequency",), "how the search for the rigid orbit ended", flags=RIGID
    ),
    "rigid_displacement": Variable(
        ("frequency",), "largest displacement of the rigid orbit", "max |Z1|"
    ),
    "rigid_multiplier_real": Variable(("frequency",), REAL),
    "rigid_multiplier_imaginary": Variable(("frequency",), IMAGINARY),
    "mended_status": Variable(
        LIMIT, "how the search for the orbit between corrected rigid walls ended", flags=RIGID
    ),
    "mended_displacement": Variable(
        LIMIT, "largest displacement of the orbit between corrected rigid walls", "max |Z1|"
    ),
    "mended_multiplier_real": Variable(LIMIT, REAL),
    "mended_multiplier_imaginary": Variable(LIMIT, IMAGINARY),
    "rigid_error": Variable(LIMIT, "relative error of max |Z1| if walls are taken as rigid"),
    "mended_error": Variable(LIMIT, "relative error of max |Z1| with corrected rigid walls"),
    "decay_error": Variable(
        LIMIT, "error of the modulus of the dominant multiplier if walls are taken as rigid"
    ),
    "rigid_verdict": Variable(
        LIMIT,
        "which of the compliant and rigid orbits were found, and whether their stability agrees",
        flags={
            "both_stable": 0,
            "both_unstable": 1,
            "stability_differs": 2,
            "rigid_only": 3,
            "compliant_only": 4,
            "neither": 5,
        },
    ),
    "threshold": Variable(("threshold",), "relative error of max |Z1| that is allowed"),
    "needed_stiffness": Variable(
        ("threshold", "frequency"),
        "contact stiffness above which rigid_error is below the threshold",
        "r1",
    ),
    "needed_status": Variable(
        ("threshold", "frequency"),
        "whether needed_stiffness lies within, below or above the grid",
        flags={"absent": -1, "found": 0, "below_grid": 1, "above_grid": 2},
    ),
    "rigid_order": Variable(("frequency",), "exponent n of rigid_error ~ r1^-n for short contacts"),
    "mended_order": Variable(
        ("frequency",), "exponent n of mended_error ~ r1^-n for short contacts"
    ),
    "own_displacement": Variable((), "largest displacement with the damper's own r1", "max |Z1|"),
    "own_error": Variable((), "relative error of own_displacement if walls are taken as rigid"),
    "own_mended_error": Variable(
        (), "relative error of own_displacement with corrected rigid walls"
    ),
    "own_decay_error": Variable(
        (), "error of the modulus of the dominant multiplier with rigid walls, for the damper's r1"
    ),
}
