"""Machines in SI units: without a damper, and contacts after Hertz."""

from impact_damper.data.variables.variable import STABILITY, Variable

VARIABLES = {
    # without the damper
    "bare_frequency": Variable(
        ("bare_point",), "frequency of an orbit without the damper", quantity="frequency"
    ),
    "bare_displacement": Variable(
        ("bare_point",), "largest displacement without the damper", quantity="displacement"
    ),
    "bare_stability": Variable(
        ("bare_point",), "stability of an orbit without the damper", flags=STABILITY
    ),
    "bare_branch": Variable(("bare_point",), "branch of an orbit without the damper"),
    # contacts after Hertz
    "hertz_status": Variable(
        (),
        "whether the contact stiffness after Hertz agrees with the stiffness used for the motion",
        flags={"consistent": 0, "not_consistent": 1, "no_contact": 2, "not_settled": 3},
    ),
    "hertz_iterations": Variable((), "number of motions computed to find this stiffness"),
    "hertz_stiffness": Variable(
        (),
        "stiffness of the linear spring that replaces the contact after Hertz",
        quantity="stiffness",
    ),
    "hertz_displacement": Variable(
        (), "largest displacement with the stiffness hertz_stiffness", quantity="displacement"
    ),
    "impact_speed": Variable(
        (), "largest relative speed at the beginning of a contact", quantity="velocity"
    ),
    "impact_compression": Variable(
        (), "largest compression of the contact", quantity="displacement"
    ),
    "impact_force": Variable((), "largest force of the contact", quantity="force"),
    "impact_duration": Variable((), "time in contact in one impact", quantity="time"),
}
