"""The contact model in closed form, contacts of motions in it, and its rigid limit."""

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
    "exit_rule": Variable(("exit_rule",), "what ends a contact"),
    "load": Variable(("load",), "load in contact", "g/(omega_n v0)"),
    "realised_restitution": Variable(CELL, "departure speed over approach speed"),
    "contact_duration": Variable(CELL, "time in contact over that of an elastic contact"),
    "contact_verdict": Variable(
        CELL,
        "realised restitution: within 1 % of e, within 5 %, off, or none since the loose mass "
        "falls back or the contact does not end",
        flags={"close": 0, "fair": 1, "off": 2, "falls_back": 3, "no_release": 4},
    ),
    "pull_impulse": Variable(CELL[1:], "impulse of the wall's pull over that of its push"),
    "pull_peak": Variable(CELL[1:], "largest pull of the wall over its largest push"),
    # without load
    "used": Variable(("used",), "coefficient of restitution of a motion's damper", "e"),
    "unloaded_damping": Variable(("used",), "damping ratio of the relative motion", "z"),
    "unloaded_restitution": Variable(UNLOADED, "realised restitution without load"),
    "unloaded_duration": Variable(UNLOADED, "time in contact over that of an elastic contact"),
    "unloaded_pull_time": Variable(("used",), "share of the contact in which the wall pulls"),
    "unloaded_pull_impulse": Variable(("used",), "impulse of the pull over that of the push"),
    "unloaded_pull_peak": Variable(("used",), "largest pull over the largest push"),
    # contacts of motions
    "size": Variable(("size",), "smallest settled or largest motion that random starts reach"),
    "scene_outcome": Variable(SCENE, "what the motion came to", flags=OUTCOME),
    "scene_displacement": Variable(SCENE, "its largest displacement", "max |Z1|"),
    "scene_without_pull": Variable(
        SCENE, "the same with the restitution that walls without pull return", "max |Z1|"
    ),
    "scene_without_pull_status": Variable(
        SCENE,
        "whether that motion was found",
        flags={
            "absent": -1,
            "found": 0,
            "not_settled": 1,
            "not_followed": 2,
            "other_contacts": 3,
        },
    ),
    "scene_contacts": Variable(SCENE, "contacts logged"),
    "scene_load": Variable(SCENE, "|load| that 99 % of the contacts do not exceed"),
    "scene_close": Variable(SCENE, "share of contacts with a restitution within 1 % of e"),
    "scene_fair": Variable(SCENE, "share of contacts with a restitution within 5 % of e"),
    "scene_restitution_low": Variable(SCENE, "least restitution of a contact"),
    "scene_restitution_high": Variable(SCENE, "largest restitution of a contact"),
    "scene_unreleased": Variable(
        SCENE, "contacts that the closed form, with a constant load, does not release"
    ),
    "scene_restitution_error": Variable(
        SCENE, "error of the closed form's restitution that 99 % of the contacts do not exceed"
    ),
    "scene_duration_error": Variable(
        SCENE, "error of the closed form's time in contact that 99 % of them do not exceed"
    ),
    "contact_used": Variable(("contact",), "place, along used, of a contact's damper"),
    "contact_row": Variable(("contact",), "place, along frequency, of a contact's motion"),
    "contact_size": Variable(("contact",), "place, along size, of a contact's motion"),
    "contact_load": Variable(("contact",), "load at the beginning of a contact"),
    "contact_restitution": Variable(("contact",), "departure speed over approach speed"),
    "contact_time": Variable(("contact",), "time in contact over that of an elastic contact"),
    # rigid limit
    "stiffness": Variable(("stiffness",), "contact stiffness", "r1"),
    "compliant_status": Variable(
        LIMIT, "how the search for the compliant orbit ended", flags=FOLLOWED
    ),
    "compliant_displacement": Variable(LIMIT, "its largest displacement", "max |Z1|"),
    "compliant_multiplier_real": Variable(LIMIT, REAL),
    "compliant_multiplier_imaginary": Variable(LIMIT, IMAGINARY),
    "rigid_status": Variable(
        ("frequency",), "how the search for the rigid orbit ended", flags=RIGID
    ),
    "rigid_displacement": Variable(("frequency",), "its largest displacement", "max |Z1|"),
    "rigid_multiplier_real": Variable(("frequency",), REAL),
    "rigid_multiplier_imaginary": Variable(("frequency",), IMAGINARY),
    "mended_status": Variable(
        LIMIT, "how the search for the mended rigid orbit ended", flags=RIGID
    ),
    "mended_displacement": Variable(LIMIT, "its largest displacement", "max |Z1|"),
    "mended_multiplier_real": Variable(LIMIT, REAL),
    "mended_multiplier_imaginary": Variable(LIMIT, IMAGINARY),
    "rigid_error": Variable(LIMIT, "relative error of max |Z1| by rigid impacts"),
    "mended_error": Variable(LIMIT, "relative error of max |Z1| by mended rigid impacts"),
    "decay_error": Variable(
        LIMIT, "error of the modulus of the dominant multiplier by rigid impacts"
    ),
    "rigid_verdict": Variable(
        LIMIT,
        "which of both orbits were reached, and whether they are stable",
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
        "where that stiffness is",
        flags={"absent": -1, "found": 0, "below_grid": 1, "above_grid": 2},
    ),
    "rigid_order": Variable(("frequency",), "n of rigid_error ~ r1^-n where contacts are short"),
    "mended_order": Variable(("frequency",), "the same of mended_error"),
    "own_displacement": Variable((), "largest displacement for the damper's own r1", "max |Z1|"),
    "own_error": Variable((), "relative error of it by rigid impacts"),
    "own_mended_error": Variable((), "relative error of it by mended rigid impacts"),
    "own_decay_error": Variable((), "error of the modulus of the dominant multiplier there"),
}
