"""The contact model in closed form, contacts of simulated motions, and the rigid limit."""

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
    "realised_restitution": Variable(CELL, "departure speed over approach speed"),
    "contact_duration": Variable(CELL, "time in contact over that of an elastic contact"),
    "contact_verdict": Variable(
        CELL,
        "realised restitution: within 1 % of e, within 5 %, further off, or none, since the loose "
        "mass falls back or the contact does not end",
        flags={"close": 0, "fair": 1, "off": 2, "falls_back": 3, "no_release": 4},
    ),
    "pull_impulse": Variable(CELL[1:], "tensile impulse of the wall over its compressive impulse"),
    "pull_peak": Variable(
        CELL[1:], "largest tensile force of the wall over its largest compressive force"
    ),
    # without load
    "used": Variable(("used",), "coefficient of restitution of a damper", "e"),
    "unloaded_damping": Variable(("used",), "damping ratio of the relative motion", "z"),
    "unloaded_restitution": Variable(UNLOADED, "realised restitution without load"),
    "unloaded_duration": Variable(UNLOADED, "time in contact over that of an elastic contact"),
    "unloaded_pull_time": Variable(("used",), "share of the time in contact with a tensile force"),
    "unloaded_pull_impulse": Variable(("used",), "tensile over compressive impulse without load"),
    "unloaded_pull_peak": Variable(
        ("used",), "largest tensile over largest compressive force without load"
    ),
    # contacts of motions
    "size": Variable(
        ("size",), "which motion that random starts reach: the smallest settled or the largest one"
    ),
    "scene_outcome": Variable(SCENE, "outcome of the motion", flags=OUTCOME),
    "scene_displacement": Variable(SCENE, "largest displacement of the motion", "max |Z1|"),
    "scene_without_pull": Variable(
        SCENE, "largest displacement with the restitution of walls that cannot pull", "max |Z1|"
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
    "scene_close": Variable(SCENE, "share of contacts with a restitution within 1 % of e"),
    "scene_fair": Variable(SCENE, "share of contacts with a restitution within 5 % of e"),
    "scene_restitution_low": Variable(SCENE, "smallest restitution of a contact"),
    "scene_restitution_high": Variable(SCENE, "largest restitution of a contact"),
    "scene_unreleased": Variable(
        SCENE, "contacts that do not end in the closed form with constant load"
    ),
    "scene_restitution_error": Variable(
        SCENE, "99 % quantile of the error of the closed-form restitution"
    ),
    "scene_duration_error": Variable(
        SCENE, "99 % quantile of the error of the closed-form time in contact"
    ),
    "contact_used": Variable(("contact",), "index along used of the damper of a contact"),
    "contact_row": Variable(("contact",), "index along frequency of the motion of a contact"),
    "contact_size": Variable(("contact",), "index along size of the motion of a contact"),
    "contact_load": Variable(("contact",), "load at the beginning of a contact"),
    "contact_restitution": Variable(("contact",), "departure speed over approach speed"),
    "contact_time": Variable(("contact",), "time in contact over that of an elastic contact"),
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
        LIMIT, "how the search for the mended rigid orbit ended", flags=RIGID
    ),
    "mended_displacement": Variable(
        LIMIT, "largest displacement of the mended rigid orbit", "max |Z1|"
    ),
    "mended_multiplier_real": Variable(LIMIT, REAL),
    "mended_multiplier_imaginary": Variable(LIMIT, IMAGINARY),
    "rigid_error": Variable(LIMIT, "relative error of max |Z1| by rigid impacts"),
    "mended_error": Variable(LIMIT, "relative error of max |Z1| by mended rigid impacts"),
    "decay_error": Variable(
        LIMIT, "error of the modulus of the dominant multiplier by rigid impacts"
    ),
    "rigid_verdict": Variable(
        LIMIT,
        "which of the compliant and rigid orbits were reached, and their stability",
        flags={
            "both_stable": 0,
            "both_unstable": 1,
            "stability_differs": 2,
            "rigid_only": 3,
            "compliant_only": 4,
            "neither": 5,
        },
    ),
    "threshold": Variable(("threshold",), "relative error of max |Z1|"),
    "needed_stiffness": Variable(
        ("threshold", "frequency"), "contact stiffness above which the error is smaller", "r1"
    ),
    "needed_status": Variable(
        ("threshold", "frequency"),
        "where needed_stiffness lies",
        flags={"absent": -1, "found": 0, "below_grid": 1, "above_grid": 2},
    ),
    "rigid_order": Variable(("frequency",), "exponent n of rigid_error ~ r1^-n for short contacts"),
    "mended_order": Variable(
        ("frequency",), "exponent n of mended_error ~ r1^-n for short contacts"
    ),
    "own_displacement": Variable((), "largest displacement for the damper's own r1", "max |Z1|"),
    "own_error": Variable((), "relative error of own_displacement by rigid impacts"),
    "own_mended_error": Variable((), "relative error of own_displacement by mended rigid impacts"),
    "own_decay_error": Variable(
        (), "error of the modulus of the dominant multiplier for the damper's own r1"
    ),
}
