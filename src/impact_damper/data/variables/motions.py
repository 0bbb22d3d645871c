"""Coordinates, states and motions, and responses as functions of a parameter."""

from impact_damper.data.variables.variable import END, OUTCOME, Variable

VARIABLES = {
    # coordinates
    "frequency": Variable(("frequency",), "forcing frequency", "Omega", quantity="frequency"),
    "clearance": Variable(
        ("clearance",), "clearance of the loose mass", "d0", quantity="clearance"
    ),
    "restitution": Variable(("restitution",), "coefficient of restitution", "e"),
    "contact_stiffness": Variable(
        ("contact_stiffness",), "stiffness of the contact", "r1", quantity="stiffness"
    ),
    "time": Variable(("time",), "time", "T", quantity="time"),
    # state
    "displacement": Variable(
        ("time",), "displacement of the primary mass", "Z1", quantity="displacement"
    ),
    "velocity": Variable(("time",), "velocity of the primary mass", "Z1'", quantity="velocity"),
    "relative_displacement": Variable(
        ("time",),
        "displacement of the primary mass relative to the loose mass",
        "Z2",
        quantity="displacement",
    ),
    "relative_velocity": Variable(
        ("time",),
        "velocity of the primary mass relative to the loose mass",
        "Z2'",
        quantity="velocity",
    ),
    # motions
    "component": Variable(("component",), "component of the state"),
    "state": Variable(
        ("component",), "state of the motion at the phase Omega T = pi/2", quantity="state"
    ),
    "state_phase": Variable((), "phase Omega T at which states are given", units="radian"),
    "contact_wall": Variable(("contact",), "wall of a contact, -1 or 1"),
    "contact_begin": Variable(("contact",), "beginning of a contact", quantity="time"),
    "contact_end": Variable(("contact",), "end of a contact", quantity="time"),
    "approach_velocity": Variable(
        ("contact",), "relative velocity at the beginning of a contact", "Z2'", quantity="velocity"
    ),
    "escape_time": Variable(
        (),
        "time of the first sample after the motion has escaped over a barrier, or NaN",
        "T",
        quantity="time",
    ),
    "departure_velocity": Variable(
        ("contact",), "relative velocity at the end of a contact", "Z2'", quantity="velocity"
    ),
    "outcome": Variable(("frequency", "motion"), "outcome of the motion", flags=OUTCOME),
    "period": Variable(("frequency", "motion"), "period of the motion in cycles", "n"),
    "contacts": Variable(("frequency", "motion"), "contacts begun per cycle"),
    "maximum_displacement": Variable(
        ("frequency", "motion"), "largest displacement", "max |Z1|", quantity="displacement"
    ),
    "asymmetry": Variable(
        ("frequency", "motion"),
        "distance of the motion from its mirror image half a period later",
        quantity="mixed",
    ),
    "phase_relative": Variable(
        ("frequency", "motion"), "phase of Z1 minus phase of Z2, first harmonics", units="radian"
    ),
    "phase_loose": Variable(
        ("frequency", "motion"),
        "phase of Z1 minus phase of Z1 - Z2, first harmonics",
        units="radian",
    ),
    "multiplier_real": Variable(("frequency", "motion"), "dominant Floquet multiplier, real part"),
    "multiplier_imaginary": Variable(
        ("frequency", "motion"), "dominant Floquet multiplier, imaginary part"
    ),
    "residual": Variable(
        ("frequency", "motion"),
        "distance between the state and the state a period later",
        quantity="mixed",
    ),
    "lyapunov_exponent": Variable(
        ("frequency", "motion"), "largest Lyapunov exponent per unit time", quantity="rate"
    ),
    "lyapunov_error": Variable(
        ("frequency", "motion"), "standard error of the largest Lyapunov exponent", quantity="rate"
    ),
    "first_frequency": Variable(
        ("frequency", "motion"),
        "first frequency of a quasi-periodic motion, the forcing frequency divided by the number "
        "of closed curves of the strobe states",
        quantity="frequency",
    ),
    "second_frequency": Variable(
        ("frequency", "motion"),
        "second frequency of a quasi-periodic motion, at most half of the first",
        quantity="frequency",
    ),
    "frequency_error": Variable(
        ("frequency", "motion"),
        "difference of the second frequency between the halves of the run",
        quantity="frequency",
    ),
    "periods_run": Variable(("frequency", "motion"), "cycles run before the motion settled"),
    # frequency responses
    "branch": Variable(
        ("frequency", "motion"),
        "number of the branch on which a motion lies, the same at all values of the sweep",
    ),
    "motion_starts": Variable(
        ("frequency", "motion"), "number of random starts that lead to the motion"
    ),
    "share_lower": Variable(
        ("frequency", "motion"),
        "share of random starts that lead to the motion, lower end of its 95 % interval",
    ),
    "share_upper": Variable(
        ("frequency", "motion"),
        "share of random starts that lead to the motion, upper end of its 95 % interval",
    ),
    "origin": Variable(
        ("frequency", "motion"),
        "how the motion was first found",
        flags={"absent": 0, "random_start": 1, "followed": 2, "placed_start": 3},
    ),
    "run_outcome": Variable(("frequency", "start"), "outcome of a random start", flags=OUTCOME),
    "run_motion": Variable(
        ("frequency", "start"),
        "index along the dimension `motion` of the motion to which a random start leads",
    ),
    "run_length": Variable(("frequency", "start"), "cycles run from a random start"),
    "end_value": Variable(
        ("end",), "parameter of the sweep at the end of a branch", quantity="followed"
    ),
    "end_branch": Variable(("end",), "branch that ends"),
    "end_direction": Variable(
        ("end",), "direction of the sweep in which the branch ends", flags={"down": -1, "up": 1}
    ),
    "end_event": Variable(("end",), "event that ends the branch", flags=END),
    "end_displacement": Variable(
        ("end",),
        "largest displacement of the primary mass at the end of a branch",
        quantity="displacement",
    ),
    "end_multiplier_real": Variable(("end",), "dominant Floquet multiplier at the end, real part"),
    "end_multiplier_imaginary": Variable(
        ("end",), "dominant Floquet multiplier at the end, imaginary part"
    ),
    # lives of chaotic motions
    "life_ends": Variable(
        ("frequency", "motion"),
        "number of runs of the chaotic motion that ended, -1 if it is not chaotic or none was run",
    ),
    "mean_life": Variable(("frequency", "motion"), "mean life of the chaotic motion in cycles"),
    "mean_life_lower": Variable(
        ("frequency", "motion"), "mean life, lower end of its 95 % interval, cycles"
    ),
    "mean_life_upper": Variable(
        ("frequency", "motion"), "mean life, upper end of its 95 % interval, cycles"
    ),
    # range of the random starts
    "start_displacement": Variable(
        ("frequency",),
        "largest displacement of a random start",
        "|Z1|",
        quantity="displacement",
    ),
    "start_speed": Variable(
        ("frequency",), "largest speed of a random start", "|Z1'|", quantity="velocity"
    ),
    "free_displacement": Variable(
        ("frequency",),
        "largest displacement of the free motions; by harmonic balance if a radius was given",
        "max |Z1|",
        quantity="displacement",
    ),
    "free_speed": Variable(
        ("frequency",),
        "largest speed of the free motions; by harmonic balance if a radius was given",
        "max |Z1'|",
        quantity="velocity",
    ),
    "missed_share": Variable(
        (), "upper bound, at 95 %, on the share of starts that lead to a motion not found"
    ),
    # first collisions
    "ball": Variable(("ball",), "ball of states from which random starts are drawn"),
    "beyond_wall": Variable(("ball",), "share of starts that lie beyond a wall"),
    "colliding": Variable(("ball",), "share of starts that lead to a collision"),
    "longest_wait": Variable(("ball",), "longest time to the first collision, cycles"),
}
