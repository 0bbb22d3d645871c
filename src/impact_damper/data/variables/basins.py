"""Basins of attraction: the motion to which each state of a plane leads, and their boundaries.

An attractor is a periodic motion on which motions settle. BASIN_LABEL lists the negative labels.
"""

from impact_damper.data.variables.variable import Variable

# Labels of states that lead to no attractor. With a damper a state of the primary mass is `mixed`
# if the place of the loose mass decides to which attractor it leads.
BASIN_LABEL = {
    "unresolved": -1,
    "escaped": -2,
    "chaotic": -3,
    "no_contact": -4,
    "mixed": -5,
    "quasi_periodic": -6,
}
CURVE = {"complete": 0, "cut": 1}

VARIABLES = {
    "basin_displacement": Variable(
        ("basin_displacement",),
        "initial displacement of the primary mass",
        "Z1",
        quantity="displacement",
    ),
    "basin_velocity": Variable(
        ("basin_velocity",), "initial velocity of the primary mass", "Z1'", quantity="velocity"
    ),
    "basin_phase": Variable((), "initial phase Omega T of the forcing", units="radian"),
    "basin_label": Variable(
        ("basin_velocity", "basin_displacement"),
        "attractor to which a state leads, or a negative number: -1 unresolved, -2 escaped, "
        "-3 chaotic, -4 without contact, -5 depends on the place of the loose mass, "
        "-6 quasi-periodic",
    ),
    "basin_periods": Variable(
        ("basin_velocity", "basin_displacement"),
        "cycles after which the motion from a state is decided",
    ),
    "basin_share": Variable(
        ("attractor", "basin_velocity", "basin_displacement"),
        "fraction of the places of the loose mass from which a state leads to an attractor",
    ),
    "attractor": Variable(("attractor",), "index of an attractor, by rising max |Z1|"),
    "attractor_period": Variable(("attractor",), "period in cycles", "n"),
    "attractor_displacement": Variable(
        ("attractor",), "largest displacement", "max |Z1|", quantity="displacement"
    ),
    "attractor_amplitude": Variable(
        ("attractor",),
        "amplitude of the first harmonic of the displacement",
        quantity="displacement",
    ),
    "attractor_phase": Variable(
        ("attractor",), "phase of the first harmonic relative to the forcing", units="radian"
    ),
    "attractor_share": Variable(("attractor",), "share of the states that lead to an attractor"),
    "attractor_point": Variable(
        ("attractor", "passage"),
        "displacement of an attractor whenever the forcing has the phase of the plane",
        "Z1",
        quantity="displacement",
    ),
    "attractor_speed": Variable(
        ("attractor", "passage"),
        "velocity of an attractor whenever the forcing has the phase of the plane",
        "Z1'",
        quantity="velocity",
    ),
    "label_count": Variable(
        ("without_attractor",), "number of states that lead to no attractor, by reason"
    ),
    "without_attractor": Variable(
        ("without_attractor",), "reason why a state leads to no attractor"
    ),
    "saddle_period": Variable(("saddle",), "period of an unstable orbit in cycles", "n"),
    "saddle_displacement": Variable(
        ("saddle",),
        "displacement of an unstable orbit at the phase of the plane",
        "Z1",
        quantity="displacement",
    ),
    "saddle_velocity": Variable(
        ("saddle",),
        "velocity of an unstable orbit at the phase of the plane",
        "Z1'",
        quantity="velocity",
    ),
    "saddle_multiplier": Variable(
        ("saddle", "multiplier"), "Floquet multipliers of an unstable orbit"
    ),
    "saddle_curve": Variable(
        ("saddle",), "whether the stable manifold is complete in the plane", flags=CURVE
    ),
    "boundary_displacement": Variable(
        ("boundary",),
        "displacement on the stable manifold of an unstable orbit; NaN between pieces",
        "Z1",
        quantity="displacement",
    ),
    "boundary_velocity": Variable(
        ("boundary",),
        "velocity on the stable manifold of an unstable orbit; NaN between pieces",
        "Z1'",
        quantity="velocity",
    ),
    "boundary_saddle": Variable(("boundary",), "index of the unstable orbit"),
}
