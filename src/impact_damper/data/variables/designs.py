"""Design of a damper: screening, comparison of gaps, cliff, deviations, masses, motions.

Screening is the first look at a design, by harmonic balance, rules and orbits. The cliff is the end
of the range of gaps with quiet motions. Deviations are errors of the built machine and damper. An
edge is a curve in the plane of two parameters on which the quiet orbit loses its stability.
"""

from impact_damper.data.variables.variable import Variable

CELL = ("candidate", "frequency")
BOUND = "bound"
# Why a quiet orbit ceases to be stable.
ENDS = {
    "no_orbit": -1,
    "fold": 0,
    "symmetry_breaking": 1,
    "neimark_sacker": 2,
    "branch_ends": 3,
    "range_ends": 4,
}
# Bifurcations at which a quiet orbit loses its stability.
EDGES = {"fold": 0, "symmetry_breaking": 1, "neimark_sacker": 2}
VARIABLES = {
    # screening
    "worst_frequency": Variable(
        (), "frequency at which the machine without damper moves most", quantity="frequency"
    ),
    "balance_displacement": Variable(
        ("frequency",),
        "largest displacement without damper by harmonic balance",
        quantity="displacement",
    ),
    "orbit_limit": Variable(
        (),
        "geometric mean of the displacements of the machine alone and of its smallest quiet orbit",
        quantity="displacement",
    ),
    "displacement_limit": Variable(
        (), "quiet limit: largest displacement of a quiet motion", quantity="displacement"
    ),
    "flight_gap": Variable(
        (), "gap by the rule of straight flight at worst_frequency", quantity="displacement"
    ),
    "manifold_gap": Variable(
        (), "gap by the slow invariant manifold at resonance", quantity="displacement"
    ),
    "screened_gap": Variable(("screened",), "gap of a quiet orbit", quantity="displacement"),
    "screened_displacement": Variable(
        ("screened", "frequency"),
        "largest displacement of the quiet orbit",
        quantity="displacement",
    ),
    "screened_modulus": Variable(
        ("screened", "frequency"),
        "modulus of the largest multiplier of the quiet orbit over half a period",
    ),
    "best_orbit_frequency": Variable(
        (),
        "frequency at which the machine alone moves most, among those with a stable quiet orbit",
        quantity="frequency",
    ),
    "best_orbit_gap": Variable(
        (),
        "gap of the smallest stable quiet orbit, the best orbit, at best_orbit_frequency",
        quantity="displacement",
    ),
    "best_orbit_displacement": Variable(
        (), "largest displacement of the best orbit", quantity="displacement"
    ),
    "best_orbit_modulus": Variable((), "modulus of the largest multiplier of the best orbit"),
    "best_orbit_edge": Variable(
        (),
        "smallest gap above best_orbit_gap at which a multiplier of the orbit has the modulus 1",
        quantity="displacement",
    ),
    "best_orbit_status": Variable(
        (),
        "how the best orbit was found",
        flags={
            "absent": 0,
            "smooth": 1,
            "kink": 2,
            "stability_ends": 3,
            "range_ends": 4,
            "not_refined": 5,
        },
    ),
    "screen_motions": Variable((), "number of motions that the screening ran"),
    "screen_orbits": Variable((), "number of exact orbits that the screening computed"),
    # comparison of gaps
    "coarse_gap": Variable(("coarse",), "gap of the coarse comparison", quantity="displacement"),
    "coarse_displacement": Variable(
        ("coarse",), "largest displacement over the band", quantity="displacement"
    ),
    "coarse_share": Variable(
        ("coarse",),
        "share of starts that lead to quiet motions, at the worst frequency of the band",
    ),
    "candidate_gap": Variable(("candidate",), "gap of a candidate", quantity="displacement"),
    "start_count": Variable(
        CELL, "number of random starts; smaller where few starts show that the gap is not quiet"
    ),
    "start_quiet_share": Variable(CELL, "share of random starts that lead to quiet motions"),
    "start_quiet_interval": Variable((*CELL, "side"), "95 % interval of start_quiet_share"),
    "worst_displacement": Variable(
        CELL, "largest displacement of all motions that starts lead to", quantity="displacement"
    ),
    "median_displacement": Variable(
        CELL,
        "median of the largest displacements of the motions that starts lead to",
        quantity="displacement",
    ),
    "quiet_time_median": Variable(CELL, "median of the cycles in which quiet motions settle"),
    "quiet_time_late": Variable(CELL, "cycles in which 95 % of the quiet motions settle"),
    "chaotic_share": Variable(CELL, "share of starts that lead to chaos"),
    "uncertain_share": Variable(
        CELL, "share of starts whose motion had neither settled nor was certainly chaotic"
    ),
    "design_gap": Variable((), "gap chosen, the full play", quantity="displacement"),
    "design_choice": Variable(
        (),
        "why the gap design_gap was chosen",
        flags={"robust": 0, "needs_tolerance": 1, "least_worst": 2},
    ),
    "tried_restitution": Variable(
        ("tried",), "restitution that was tried, where it is free within a range"
    ),
    "tried_gap": Variable(("tried",), "best gap with this restitution", quantity="displacement"),
    "tried_displacement": Variable(
        ("tried",),
        "largest displacement with this restitution over band, starts and tolerated gaps",
        quantity="displacement",
    ),
    "tried_choice": Variable(
        ("tried",),
        "why the gap tried_gap was chosen",
        flags={"robust": 0, "needs_tolerance": 1, "least_worst": 2},
    ),
    "compared_motions": Variable((), "number of motions that the comparison of gaps ran"),
    # cliff
    "side": Variable(("side",), "lower or upper end"),
    "cliff_gap": Variable(("side",), "last quiet gap", quantity="displacement"),
    "cliff_beyond": Variable(("side",), "first gap that is not quiet", quantity="displacement"),
    "cliff_status": Variable(
        ("side",),
        "how the end of the quiet gaps was found",
        flags={"found": 0, "range_ends": 1, "no_quiet_gap": 2},
    ),
    "cliff_frequency": Variable(
        ("side",), "frequency at which quiet gaps end first", quantity="frequency"
    ),
    "life_gap": Variable(
        ("life",),
        "gap at which the lives of violent motions were observed",
        quantity="displacement",
    ),
    "life_share": Variable(
        ("life", BOUND), "share of starts whose motion is quiet at the end of the longest run"
    ),
    "life_rate": Variable(("life", BOUND), "rate at which violent motions become quiet, per cycle"),
    "branch_frequency": Variable(
        (), "frequency at which the quiet orbit is followed", quantity="frequency"
    ),
    "gap_of_orbit": Variable(("gap_point",), "gap of an orbit", quantity="displacement"),
    "displacement_by_gap": Variable(
        ("gap_point",), "largest displacement of the orbit at gap_of_orbit", quantity="displacement"
    ),
    "modulus_by_gap": Variable(
        ("gap_point",), "modulus of the largest multiplier of the orbit at gap_of_orbit"
    ),
    "force_of_orbit": Variable(("force_point",), "multiple of the nominal force of an orbit"),
    "displacement_by_force": Variable(
        ("force_point",),
        "largest displacement of the orbit at force_of_orbit",
        quantity="displacement",
    ),
    "modulus_by_force": Variable(
        ("force_point",), "modulus of the largest multiplier of the orbit at force_of_orbit"
    ),
    "stability_gap": Variable(
        ("side",), "gap at which the quiet orbit ceases to be stable", quantity="displacement"
    ),
    "stability_force": Variable(
        ("side",), "multiple of the nominal force at which the quiet orbit ceases to be stable"
    ),
    "stability_gap_event": Variable(
        ("side",), "why the quiet orbit ceases to be stable at stability_gap", flags=ENDS
    ),
    "stability_force_event": Variable(
        ("side",), "why the quiet orbit ceases to be stable at stability_force", flags=ENDS
    ),
    "changed": Variable(("changed",), "parameter that grows by 1 per cent"),
    "displacement_change": Variable(
        ("changed",), "change of the largest displacement of the quiet orbit, per cent"
    ),
    "modulus_change": Variable(
        ("changed",), "change of the modulus of the orbit's largest multiplier, per cent"
    ),
    # deviations
    "varied": Variable(("varied",), "quantity that deviates from its nominal value"),
    "sample_factor": Variable(("sample", "varied"), "value divided by the nominal one"),
    "sample_displacement": Variable(
        ("sample",), "largest displacement over the band", quantity="displacement"
    ),
    "sample_share": Variable(
        ("sample", BOUND), "share of starts over the band that lead to quiet motions"
    ),
    "sample_least_share": Variable(
        ("sample",),
        "share of starts that lead to quiet motions, at the worst frequency of the band",
    ),
    "corner_factor": Variable(("corner", "varied"), "value divided by the nominal one"),
    "corner_displacement": Variable(
        ("corner",), "largest displacement over the band", quantity="displacement"
    ),
    "corner_share": Variable(("corner", BOUND), "share of new starts that lead to quiet motions"),
    "corner_least_share": Variable(
        ("corner",),
        "share of starts that lead to quiet motions, at the worst frequency of the band",
    ),
    "promised_displacement": Variable(
        (), "largest displacement promised within the tolerances", quantity="displacement"
    ),
    "promise": Variable(
        (),
        "promise of the design, and whether new starts confirmed it",
        flags={"none_made": 0, "nominal_kept": 1, "robust_kept": 2, "broken": 3},
    ),
    "map_gap": Variable(("map_gap",), "gap of a cell of the map", quantity="displacement"),
    "map_restitution": Variable(("map_restitution",), "restitution of a cell of the map"),
    "operating_frequency": Variable(
        ("operating_frequency",), "frequency of a cell of the map", quantity="frequency"
    ),
    "damper_map_share": Variable(
        ("map_gap", "map_restitution"), "share of starts that lead to quiet motions"
    ),
    "damper_map_displacement": Variable(
        ("map_gap", "map_restitution"), "largest displacement", quantity="displacement"
    ),
    "force_map_share": Variable(
        ("operating_frequency", "force_share"), "share of starts that lead to quiet motions"
    ),
    "force_map_displacement": Variable(
        ("operating_frequency", "force_share"), "largest displacement", quantity="displacement"
    ),
    "force_edge_frequency": Variable(
        ("force_edge",), "frequency at an edge of the quiet orbit", quantity="frequency"
    ),
    "force_edge_share": Variable(
        ("force_edge",), "multiple of the nominal force at an edge of the quiet orbit"
    ),
    "force_edge_kind": Variable(
        ("force_edge",), "bifurcation of the quiet orbit on the edge", flags=EDGES
    ),
    "force_edge_number": Variable(("force_edge",), "number of the edge"),
    "force_edges_lost": Variable((), "number of changes of stability for which no edge was found"),
    "damper_edge_gap": Variable(
        ("damper_edge",), "gap at an edge of the quiet orbit", quantity="displacement"
    ),
    "damper_edge_restitution": Variable(
        ("damper_edge",), "restitution at an edge of the quiet orbit"
    ),
    "damper_edge_kind": Variable(
        ("damper_edge",), "bifurcation of the quiet orbit on the edge", flags=EDGES
    ),
    "damper_edge_number": Variable(("damper_edge",), "number of the edge"),
    "damper_edges_lost": Variable((), "number of changes of stability for which no edge was found"),
    # masses
    "other_mass": Variable(("other",), "loose mass", quantity="mass"),
    "other_gap": Variable(("other",), "gap chosen for this loose mass", quantity="displacement"),
    "other_displacement": Variable(
        ("other",), "largest displacement within the tolerance of the gap", quantity="displacement"
    ),
    "other_share": Variable(
        ("other",), "share of starts that lead to quiet motions, at the worst frequency of the band"
    ),
    "other_force": Variable(("other",), "largest contact force over the band", quantity="force"),
    "other_best": Variable(
        ("other",),
        "whether no other mass is better in mass, displacement and force together",
        flags={"no": 0, "yes": 1},
    ),
    # transients
    "sweep_time": Variable(("direction", "sweep_window"), "time", quantity="time"),
    "sweep_frequency": Variable(
        ("direction", "sweep_window"), "forcing frequency", quantity="frequency"
    ),
    # motions of the design
    "motion_rms": Variable(
        ("frequency",),
        "r.m.s. displacement of the largest motion that starts lead to",
        quantity="displacement",
    ),
    "motion_peak_mean": Variable(
        ("frequency",), "mean over cycles of the peaks of this motion", quantity="displacement"
    ),
    "motion_peak_high": Variable(
        ("frequency",), "95th percentile of the peaks of this motion", quantity="displacement"
    ),
    "reached_displacement": Variable(
        ("frequency",),
        "largest displacement of all motions that starts lead to",
        quantity="displacement",
    ),
    "untouched_displacement": Variable(
        ("frequency",),
        "largest displacement of a motion in which the loose mass touches no wall and to which no "
        "random start leads",
        quantity="displacement",
    ),
    "reached_quiet_share": Variable(
        ("frequency",), "share of random starts that lead to quiet motions"
    ),
    "reached_quiet_interval": Variable(
        ("frequency", "side"), "95 % interval of reached_quiet_share"
    ),
    "impact_rate_by_frequency": Variable(("frequency",), "impacts per time", quantity="rate"),
    "contact_force_by_frequency": Variable(
        ("frequency",), "largest force in a contact", quantity="force"
    ),
    "penetration_by_frequency": Variable(
        ("frequency",), "largest penetration of a wall", quantity="displacement"
    ),
    "impact_speed_by_frequency": Variable(
        ("frequency",), "largest relative speed of an impact", quantity="velocity"
    ),
    "impact_loss_by_frequency": Variable(
        ("frequency",), "mean energy lost in an impact", quantity="energy"
    ),
    "impact_power_by_frequency": Variable(
        ("frequency",), "mean power lost in contacts", quantity="power"
    ),
    "pressure_by_frequency": Variable(
        ("frequency",), "largest pressure after Hertz", quantity="pressure"
    ),
    "yields_by_frequency": Variable(
        ("frequency",),
        "whether the material yields at this pressure",
        flags={"no": 0, "yes": 1, "unknown": 2},
    ),
    "noise_by_frequency": Variable(
        ("frequency",), "sum of the squared impulses of impacts, per time", quantity="impulse_noise"
    ),
    # competitors
    "den_hartog_stiffness": Variable(
        (), "stiffness of a tuned absorber by Den Hartog's closed form", quantity="stiffness"
    ),
    "den_hartog_damping": Variable(
        (), "damping of Den Hartog's absorber by Brock's closed form", quantity="damping"
    ),
}
