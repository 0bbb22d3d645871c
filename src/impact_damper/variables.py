"""The registry: what each variable in a dataset is called, measured in, and means."""

from typing import NamedTuple


class Variable(NamedTuple):
    """One variable of the datasets.

    Attributes
    ----------
    dims : tuple of str
        Usual dimensions.
    long_name : str
        What it is, in words.
    symbol : str
        The paper's symbol, or "".
    units : str
        "1" for dimensionless.
    flags : dict or None
        Value of each flag by its meaning.
    """

    dims: tuple
    long_name: str
    symbol: str = ""
    units: str = "1"
    flags: dict | None = None


STABILITY = {"absent": -2, "unstable": -1, "marginal": 0, "stable": 1}
OUTCOME = {
    "absent": -1,
    "unresolved": 0,
    "settled": 1,
    "chaotic": 2,
    "diverged": 3,
    "non_colliding": 4,
}
MINIMUM = {"not_found": 0, "smooth": 1, "kink": 2, "jump": 3, "edge": 4}
# A damped period-1 motion is quiet below half the displacement of the free resonance motion.
DAMPED_MOTION = {"none": -1, "unsettled": 0, "quiet": 1, "violent": 2, "subharmonic": 3}
FREE_MOTION = {
    "none": -1,
    "unresolved": 0,
    "non_resonance": 1,
    "resonance": 2,
    "subharmonic": 3,
    "other": 4,
}
END = {
    "not_smooth": 0,
    "fold": 1,
    "symmetry_breaking": 2,
    "period_doubling": 3,
    "neimark_sacker": 4,
}
SUBHARMONIC_END = END | {"sweep_ends": 5, "not_found": 6}
SUPPRESSION = {"no_subharmonic_without_damper": 0, "removed": 1, "reduced": 2, "unchanged": 3}

VARIABLES = {
    # coordinates
    "frequency": Variable(("frequency",), "forcing frequency", "Omega"),
    "clearance": Variable(("clearance",), "clearance of the loose mass", "d0"),
    "time": Variable(("time",), "time", "T"),
    # state
    "displacement": Variable(("time",), "displacement of the primary mass", "Z1"),
    "velocity": Variable(("time",), "velocity of the primary mass", "Z1'"),
    "relative_displacement": Variable(
        ("time",), "displacement of the primary relative to the loose mass", "Z2"
    ),
    "relative_velocity": Variable(
        ("time",), "velocity of the primary relative to the loose mass", "Z2'"
    ),
    # harmonic balance
    "amplitude": Variable(
        ("frequency", "solution"), "amplitude of Z1, negative in antiphase to Z2", "a"
    ),
    "relative_amplitude": Variable(("frequency", "solution"), "amplitude of Z2", "b"),
    "phase": Variable(("frequency", "solution"), "phase of Z1 to the forcing", "theta_1", "radian"),
    "kind": Variable(
        ("frequency", "solution"),
        "whether the loose mass touches the walls",
        flags={"absent": 0, "impacting": 1, "resting": 2},
    ),
    "growth_rate": Variable(
        ("frequency", "solution"), "largest real part of the eigenvalues of the slow flow"
    ),
    "stability": Variable(("frequency", "solution"), "stability by the slow flow", flags=STABILITY),
    "solution_count": Variable(("frequency",), "solutions of the harmonic balance"),
    "balance_status": Variable(
        ("frequency",),
        "how the solution of the harmonic balance ended",
        flags={"solved": 0, "unresolved": 1},
    ),
    "free_amplitude": Variable(
        ("frequency", "free_solution"), "amplitude of Z1 without the damper", "a"
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
    "free_count": Variable(("frequency",), "solutions of the harmonic balance without the damper"),
    "rigid_tangent": Variable(("frequency", "root"), "root of the polynomial (14)", "D"),
    "rigid_amplitude": Variable(
        ("frequency", "root"), "amplitude of Z1 for rigid walls, negative in antiphase", "a"
    ),
    "rigid_phase": Variable(
        ("frequency", "root"), "phase of Z1 to the forcing for rigid walls", "theta_1", "radian"
    ),
    "rigid_wall": Variable(
        ("frequency", "root"),
        "whether rigid walls push or would have to pull",
        flags={"absent": 0, "pushes": 1, "pulls": 2},
    ),
    "rigid_residual": Variable(("frequency", "root"), "residual of (13)"),
    "rigid_count": Variable(("frequency",), "real roots of the polynomial (14)"),
    # suppression band
    "peak_frequency": Variable((), "peak frequency without the damper", "Omega_p"),
    "peak_amplitude": Variable((), "amplitude of Z1 without the damper at the peak frequency"),
    "quiet_amplitude": Variable((), "amplitude |a| of the quiet motion at the peak frequency"),
    "reduction": Variable((), "1 - |a|/(amplitude without the damper) at the peak frequency"),
    "band_status": Variable(
        (),
        "whether there is a suppression band at the peak frequency",
        flags={"found": 0, "no_single_motion": 1, "no_reduction": 2},
    ),
    "edge": Variable(("edge",), "lower or upper end of a range"),
    "edge_frequency": Variable(("edge",), "edge of the suppression band"),
    "edge_reduction": Variable(
        ("edge",), "1 - |a|/(amplitude without the damper) at the edge of the suppression band"
    ),
    "edge_event": Variable(
        ("edge",),
        "what ends the suppression band",
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
    "band_width": Variable((), "width of the suppression band", "Delta Omega_s"),
    "break_even_frequency": Variable(
        (), "frequency above the peak where |a| reaches the least amplitude without the damper"
    ),
    # motions
    "component": Variable(("component",), "component of the state"),
    "state": Variable(("component",), "state of the motion at the phase Omega T = pi/2"),
    "contact_wall": Variable(("contact",), "wall of a contact, -1 or 1"),
    "contact_begin": Variable(("contact",), "beginning of a contact"),
    "contact_end": Variable(("contact",), "end of a contact"),
    "approach_velocity": Variable(("contact",), "relative velocity at its beginning", "Z2'"),
    "departure_velocity": Variable(("contact",), "relative velocity at its end", "Z2'"),
    "outcome": Variable(("frequency", "motion"), "what the motion came to", flags=OUTCOME),
    "period": Variable(("frequency", "motion"), "period of the motion in forcing periods", "n"),
    "contacts": Variable(("frequency", "motion"), "contacts begun per forcing period"),
    "maximum_displacement": Variable(("frequency", "motion"), "largest displacement", "max |Z1|"),
    "asymmetry": Variable(
        ("frequency", "motion"), "distance of the motion from its mirror image half a period on"
    ),
    "phase_relative": Variable(
        ("frequency", "motion"), "phase of Z1 to Z2, first harmonics", units="radian"
    ),
    "phase_loose": Variable(
        ("frequency", "motion"), "phase of Z1 to Z1 - Z2, first harmonics", units="radian"
    ),
    "multiplier_real": Variable(("frequency", "motion"), "dominant Floquet multiplier, real part"),
    "multiplier_imaginary": Variable(
        ("frequency", "motion"), "dominant Floquet multiplier, imaginary part"
    ),
    "residual": Variable(("frequency", "motion"), "distance of the state from its return"),
    "lyapunov_exponent": Variable(
        ("frequency", "motion"), "largest Lyapunov exponent per unit time"
    ),
    "lyapunov_error": Variable(
        ("frequency", "motion"), "standard error of the largest Lyapunov exponent"
    ),
    "periods_run": Variable(("frequency", "motion"), "forcing periods run before it settled"),
    # frequency responses
    "branch": Variable(("frequency", "motion"), "number of the branch a motion belongs to"),
    "share": Variable(("frequency", "motion"), "random starts that lead to the motion"),
    "origin": Variable(
        ("frequency", "motion"),
        "how the motion was found first",
        flags={"absent": 0, "random_start": 1, "followed": 2},
    ),
    "run_outcome": Variable(("frequency", "start"), "what a random start came to", flags=OUTCOME),
    "run_motion": Variable(("frequency", "start"), "place, along motion, of what it came to"),
    "run_length": Variable(("frequency", "start"), "forcing periods run from a random start"),
    "end_value": Variable(("end",), "parameter of the sweep at the end of a branch"),
    "end_branch": Variable(("end",), "branch that ends"),
    "end_direction": Variable(
        ("end",), "direction of the sweep in which the branch ends", flags={"down": -1, "up": 1}
    ),
    "end_event": Variable(("end",), "what ends the branch", flags=END),
    "end_displacement": Variable(
        ("end",), "largest displacement of the primary mass at the end of a branch"
    ),
    "end_multiplier_real": Variable(("end",), "dominant Floquet multiplier there, real part"),
    "end_multiplier_imaginary": Variable(
        ("end",), "dominant Floquet multiplier there, imaginary part"
    ),
    # optimum clearance
    "quiet_displacement": Variable(
        ("clearance",), "largest displacement in the quiet motion", "max |Z1|"
    ),
    "quiet_status": Variable(
        ("clearance",), "whether there is a quiet motion", flags={"absent": 0, "found": 1}
    ),
    "largest_displacement": Variable(
        ("clearance",), "largest displacement over all motions that random starts reach"
    ),
    "analytical_amplitude": Variable(
        ("clearance",), "|a| of the stable solution of (7) with the smallest one", "|a|"
    ),
    "analytical_status": Variable(
        ("clearance",),
        "whether (7) has a stable solution",
        flags={"absent": 0, "found": 1, "inelastic": 2, "unresolved": 3},
    ),
    "optimum_clearance": Variable((), "clearance at which the quiet motion is smallest", "d0"),
    "optimum_displacement": Variable((), "its largest displacement there", "max |Z1|"),
    "optimum_kind": Variable(
        (), "kind of minimum: smooth, kink, end of the branch or of the sweep", flags=MINIMUM
    ),
    "near_clearance": Variable(
        ("edge",), "ends of the clearances within 10 % of the smallest displacement"
    ),
    "near_status": Variable(
        ("edge",),
        "what ends them",
        flags={"not_found": 0, "crossed": 1, "branch_ends": 2, "sweep_ends": 3},
    ),
    "analytical_optimum": Variable((), "clearance at which (7) has a solution with a = 0", "d0"),
    "analytical_kind": Variable((), "kind of minimum of |a| there", flags=MINIMUM),
    "rule_clearance": Variable((), "clearance of rule (18) at the forcing frequency", "d0"),
    "peak_rule_clearance": Variable((), "clearance of rule (19)", "d0"),
    "optimum_ratio": Variable((), "rm W^2 d0 at the optimum, 1 by rule (18)"),
    "straight_flight_ratio": Variable(
        (), "rm W^2 d0 of the least max |Z1| for rigid walls at high frequency"
    ),
    "first_harmonic_share": Variable(
        (), "(pi^2/8 - 1)/(optimum_ratio - 1), the first harmonic of a straight flight"
    ),
    "straight_flight_share": Variable((), "(straight_flight_ratio - 1)/(optimum_ratio - 1)"),
    # migration control
    "on_time": Variable(("trial", "switching"), "time at which the damper is switched on", "T"),
    "off_time": Variable(("trial", "switching"), "time at which it is switched off", "T"),
    "end_time": Variable(("trial", "switching"), "time at which the free motion has settled", "T"),
    "released_from": Variable(
        ("trial", "switching"), "damped motion when it is switched off", flags=DAMPED_MOTION
    ),
    "released_period": Variable(
        ("trial", "switching"), "its period in forcing periods, 0 if it has not settled", "n"
    ),
    "released_displacement": Variable(
        ("trial", "switching"), "its largest displacement, if it has settled", "max |Z1|"
    ),
    "destination": Variable(
        ("trial", "switching"), "free motion that a release leads to", flags=FREE_MOTION
    ),
    "destination_displacement": Variable(
        ("trial", "switching"), "its largest displacement", "max |Z1|"
    ),
    "trial_outcome": Variable(
        ("trial",),
        "whether a run arrives on the non-resonance branch",
        flags={"not_reached": 0, "reached": 1},
    ),
    "switchings": Variable(("trial",), "times that the damper is switched on in a run"),
    "damper_time": Variable(("trial",), "forcing periods with the damper on"),
    "release_time": Variable(
        ("trial",), "forcing periods from the first switching on to the last switching off"
    ),
    "total_time": Variable(
        ("trial",), "forcing periods from the first switching on to the end of the last free run"
    ),
    "example": Variable((), "run of which the displacement is stored"),
    "bound": Variable(("bound",), "share, or lower or upper end of its 95 % interval"),
    "damped_motion": Variable(("damped_motion",), "kind of damped motion"),
    "free_motion": Variable(("free_motion",), "kind of free motion"),
    "destination_count": Variable(
        ("damped_motion", "free_motion"), "switchings of all runs by where they lead from and to"
    ),
    "reached_share": Variable(("bound",), "runs that arrive on the non-resonance branch"),
    "within_share": Variable(("bound",), "runs that arrive within 350 forcing periods"),
    # releases of each damped motion
    "damped_kind": Variable(("damped",), "kind of damped motion", flags=DAMPED_MOTION),
    "damped_period": Variable(
        ("damped",), "period in forcing periods, 0 if it has not settled", "n"
    ),
    "damped_displacement": Variable(
        ("damped",), "largest displacement, if it has settled", "max |Z1|"
    ),
    "damped_contacts": Variable(
        ("damped",), "contacts begun per forcing period, if it has settled"
    ),
    "release_phase": Variable(
        ("damped", "release"), "forcing periods from Omega T = pi/2 to the release"
    ),
    "release_displacement": Variable(
        ("damped", "release"), "displacement of the primary mass at the release", "Z1"
    ),
    "release_velocity": Variable(
        ("damped", "release"), "velocity of the primary mass at the release", "Z1'"
    ),
    "release_destination": Variable(
        ("damped", "release"), "free motion that the release leads to", flags=FREE_MOTION
    ),
    "release_share": Variable(
        ("damped", "free_motion", "bound"), "releases that lead to each free motion"
    ),
    # life of the violent transient
    "life": Variable(("run",), "forcing periods until a run is captured, if before the horizon"),
    "landing_time": Variable(("run",), "forcing periods until it has settled, if it has"),
    "landed_on": Variable(("run",), "motion on which it settles", flags=DAMPED_MOTION),
    "age": Variable(("age",), "forcing periods since the damper was switched on"),
    "survival": Variable(("age", "bound"), "runs that live longer"),
    "at_risk": Variable(("age",), "number of runs that live longer"),
    "escape_rate": Variable(("bound",), "captures per run and forcing period"),
    "horizon": Variable((), "forcing periods up to which lives are known"),
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
    # first collisions
    "ball": Variable(("ball",), "where random starts were drawn"),
    "beyond_wall": Variable(("ball",), "share of starts that lie beyond a wall"),
    "colliding": Variable(("ball",), "share of starts that lead to a collision"),
    "longest_wait": Variable(("ball",), "longest wait for the first collision, forcing periods"),
}
