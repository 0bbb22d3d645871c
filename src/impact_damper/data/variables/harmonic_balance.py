"""Single-term harmonic balance, suppression bands and optimum clearances.

Z1 is the displacement of the primary mass, Z2 its displacement relative to the loose mass, and a
and b are their amplitudes. f is the amplitude of the forcing. "Free" means without the damper.
Numbers in round brackets are equations of the paper. A suppression band is the range of frequencies
around the peak in which the damper leaves only a quiet, that is small, motion.
"""

from impact_damper.data.variables.variable import MINIMUM, STABILITY, Variable

VARIABLES = {
    # harmonic balance
    "amplitude": Variable(
        ("frequency", "solution"),
        "amplitude of Z1, negative if Z1 is in antiphase to Z2",
        "a",
        quantity="displacement",
    ),
    "relative_amplitude": Variable(
        ("frequency", "solution"), "amplitude of Z2", "b", quantity="displacement"
    ),
    "phase": Variable(("frequency", "solution"), "phase of Z1 to the forcing", "theta_1", "radian"),
    "kind": Variable(
        ("frequency", "solution"),
        "whether the loose mass touches the walls",
        flags={"absent": 0, "impacting": 1, "resting": 2},
    ),
    "growth_rate": Variable(
        ("frequency", "solution"),
        "largest real part of the eigenvalues of the slow flow",
        quantity="rate",
    ),
    "stability": Variable(("frequency", "solution"), "stability by the slow flow", flags=STABILITY),
    "solution_count": Variable(("frequency",), "number of solutions of the harmonic balance"),
    "balance_status": Variable(
        ("frequency",),
        "how the solution of the harmonic balance ended",
        flags={"solved": 0, "unresolved": 1},
    ),
    "free_amplitude": Variable(
        ("frequency", "free_solution"),
        "amplitude of Z1 without the damper",
        "a",
        quantity="displacement",
    ),
    "free_phase": Variable(
        ("frequency", "free_solution"),
        "phase of Z1 to the forcing without the damper",
        "theta_1",
        "radian",
    ),
    "free_stability": Variable(
        ("frequency", "free_solution"),
        "stability by the slow flow without the damper",
        flags=STABILITY,
    ),
    "free_count": Variable(
        ("frequency",), "number of solutions of the harmonic balance without the damper"
    ),
    "rigid_tangent": Variable(
        ("frequency", "root"), "root of the polynomial (14) for rigid walls", "D"
    ),
    "rigid_amplitude": Variable(
        ("frequency", "root"),
        "amplitude of Z1 for rigid walls, negative if Z1 is in antiphase to Z2",
        "a",
        quantity="displacement",
    ),
    "rigid_phase": Variable(
        ("frequency", "root"), "phase of Z1 to the forcing for rigid walls", "theta_1", "radian"
    ),
    "rigid_wall": Variable(
        ("frequency", "root"),
        "whether rigid walls push the loose mass, or would have to pull it",
        flags={"absent": 0, "pushes": 1, "pulls": 2},
    ),
    "rigid_residual": Variable(
        ("frequency", "root"),
        "residual of the balance for rigid walls, equation (13)",
        quantity="mixed",
    ),
    "rigid_count": Variable(
        ("frequency",), "number of real roots of the polynomial (14) for rigid walls"
    ),
    # suppression band
    "peak_frequency": Variable(
        (), "peak frequency without the damper", "Omega_p", quantity="frequency"
    ),
    "peak_amplitude": Variable(
        (), "amplitude of Z1 without the damper at the peak frequency", quantity="displacement"
    ),
    "quiet_amplitude": Variable(
        (), "amplitude |a| of the quiet motion at the peak frequency", quantity="displacement"
    ),
    "reduction": Variable((), "1 - |a|/(amplitude without the damper) at the peak frequency"),
    "band_status": Variable(
        (),
        "whether there is a suppression band at the peak frequency",
        flags={"found": 0, "no_single_motion": 1, "no_reduction": 2, "no_peak": 3},
    ),
    "edge": Variable(("edge",), "lower or upper end of a range"),
    "edge_frequency": Variable(("edge",), "edge of the suppression band", quantity="frequency"),
    "edge_reduction": Variable(
        ("edge",), "1 - |a|/(amplitude without the damper) at the edge of the suppression band"
    ),
    "edge_event": Variable(
        ("edge",),
        "event that ends the suppression band",
        flags={
            "not_found": 0,
            "resonance_branch_ends": 1,
            "other_motion_appears": 2,
            "other_motion_stabilises": 3,
            "quiet_motion_folds": 4,
            "quiet_motion_destabilises": 5,
            "no_reduction": 6,
        },
    ),
    "band_width": Variable(
        (), "width of the suppression band", "Delta Omega_s", quantity="frequency"
    ),
    "break_even_frequency": Variable(
        (),
        "frequency at which |a| equals the smallest amplitude without the damper: above the peak, "
        "or for a softening spring below",
        quantity="frequency",
    ),
    # optimum clearance
    "quiet_displacement": Variable(
        ("clearance",),
        "largest displacement in the quiet motion",
        "max |Z1|",
        quantity="displacement",
    ),
    "quiet_status": Variable(
        ("clearance",), "whether there is a quiet motion", flags={"absent": 0, "found": 1}
    ),
    "largest_displacement": Variable(
        ("clearance",),
        "largest displacement of all motions to which the random starts lead",
        quantity="displacement",
    ),
    "analytical_amplitude": Variable(
        ("clearance",),
        "smallest |a| of a stable solution of the harmonic balance (7)",
        "|a|",
        quantity="displacement",
    ),
    "analytical_status": Variable(
        ("clearance",),
        "whether the harmonic balance (7) has a stable solution",
        flags={"absent": 0, "found": 1, "inelastic": 2, "unresolved": 3},
    ),
    "optimum_clearance": Variable(
        (), "clearance at which the quiet motion is smallest", "d0", quantity="clearance"
    ),
    "optimum_displacement": Variable(
        (),
        "largest displacement in the quiet motion at the optimum clearance",
        "max |Z1|",
        quantity="displacement",
    ),
    "optimum_kind": Variable(
        (), "kind of minimum: smooth, kink, end of the branch or of the sweep", flags=MINIMUM
    ),
    "near_clearance": Variable(
        ("edge",),
        "ends of the range of clearances with at most 1.1 times the smallest displacement",
        quantity="clearance",
    ),
    "near_status": Variable(
        ("edge",),
        "event that ends the range near_clearance",
        flags={"not_found": 0, "crossed": 1, "branch_ends": 2, "sweep_ends": 3},
    ),
    "analytical_optimum": Variable(
        (),
        "clearance at which the harmonic balance (7) has a solution with a = 0",
        "d0",
        quantity="clearance",
    ),
    "analytical_kind": Variable((), "kind of minimum of |a| at analytical_optimum", flags=MINIMUM),
    "rule_clearance": Variable(
        (), "clearance of rule (18) at the forcing frequency", "d0", quantity="clearance"
    ),
    "peak_rule_clearance": Variable((), "clearance of rule (19)", "d0", quantity="clearance"),
    "optimum_ratio": Variable((), "rm W^2 d0/f at the optimum clearance, which is 1 by rule (18)"),
    "straight_flight_ratio": Variable(
        (), "rm W^2 d0/f at the smallest max |Z1| for rigid walls at high frequency"
    ),
    "first_harmonic_share": Variable(
        (),
        "fraction of optimum_ratio - 1 that the first harmonic explains, "
        "(pi^2/8 - 1)/(optimum_ratio - 1)",
    ),
    "straight_flight_share": Variable(
        (),
        "fraction of optimum_ratio - 1 explained by straight flight: (straight_flight_ratio - 1)/"
        "(optimum_ratio - 1)",
    ),
}
