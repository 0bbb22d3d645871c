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
OUTCOME = {"absent": -1, "unresolved": 0, "settled": 1, "chaotic": 2, "diverged": 3,
           "non_colliding": 4}

VARIABLES = {
    # coordinates
    "frequency": Variable(("frequency",), "forcing frequency", "Omega"),
    "clearance": Variable(("clearance",), "clearance of the loose mass", "d0"),
    "time": Variable(("time",), "time", "T"),
    # state
    "displacement": Variable(("time",), "displacement of the primary mass", "Z1"),
    "velocity": Variable(("time",), "velocity of the primary mass", "Z1'"),
    "relative_displacement": Variable(
        ("time",), "displacement of the primary relative to the loose mass", "Z2"),
    "relative_velocity": Variable(
        ("time",), "velocity of the primary relative to the loose mass", "Z2'"),
    # harmonic balance
    "amplitude": Variable(
        ("frequency", "solution"), "amplitude of Z1, negative in antiphase to Z2", "a"),
    "relative_amplitude": Variable(("frequency", "solution"), "amplitude of Z2", "b"),
    "phase": Variable(("frequency", "solution"), "phase of Z1 to the forcing", "theta_1", "radian"),
    "kind": Variable(("frequency", "solution"), "whether the loose mass touches the walls",
                     flags={"absent": 0, "impacting": 1, "resting": 2}),
    "growth_rate": Variable(
        ("frequency", "solution"), "largest real part of the eigenvalues of the slow flow"),
    "stability": Variable(("frequency", "solution"), "stability by the slow flow", flags=STABILITY),
    "solution_count": Variable(("frequency",), "solutions of the harmonic balance"),
    "balance_status": Variable(("frequency",), "how the solution of the harmonic balance ended",
                               flags={"solved": 0, "unresolved": 1}),
    "free_amplitude": Variable(
        ("frequency", "free_solution"), "amplitude of Z1 without the damper", "a"),
    "free_phase": Variable(("frequency", "free_solution"),
                           "phase of Z1 to the forcing without the damper", "theta_1", "radian"),
    "free_stability": Variable(("frequency", "free_solution"),
                               "stability by the slow flow without the damper", flags=STABILITY),
    "free_count": Variable(("frequency",), "solutions of the harmonic balance without the damper"),
    "rigid_tangent": Variable(("frequency", "root"), "root of the polynomial (14)", "D"),
    "rigid_amplitude": Variable(
        ("frequency", "root"), "amplitude of Z1 for rigid walls, negative in antiphase", "a"),
    "rigid_phase": Variable(
        ("frequency", "root"), "phase of Z1 to the forcing for rigid walls", "theta_1", "radian"),
    "rigid_wall": Variable(("frequency", "root"), "whether rigid walls push or would have to pull",
                           flags={"absent": 0, "pushes": 1, "pulls": 2}),
    "rigid_residual": Variable(("frequency", "root"), "residual of (13)"),
    "rigid_count": Variable(("frequency",), "real roots of the polynomial (14)"),
    # suppression band
    "peak_frequency": Variable((), "peak frequency without the damper", "Omega_p"),
    "peak_amplitude": Variable((), "amplitude of Z1 without the damper at the peak frequency"),
    "quiet_amplitude": Variable((), "amplitude |a| of the quiet motion at the peak frequency"),
    "reduction": Variable((), "1 - |a|/(amplitude without the damper) at the peak frequency"),
    "band_status": Variable((), "whether there is a suppression band at the peak frequency",
                            flags={"found": 0, "no_single_motion": 1, "no_reduction": 2}),
    "edge": Variable(("edge",), "edge of the suppression band"),
    "edge_frequency": Variable(("edge",), "edge of the suppression band"),
    "edge_reduction": Variable(
        ("edge",), "1 - |a|/(amplitude without the damper) at the edge of the suppression band"),
    "edge_event": Variable(("edge",), "what ends the suppression band", flags={
        "not_found": 0, "resonance_branch_ends": 1, "other_motion_appears": 2,
        "other_motion_stabilises": 3, "quiet_motion_folds": 4, "quiet_motion_destabilises": 5,
        "no_reduction": 6}),
    "band_width": Variable((), "width of the suppression band", "Delta Omega_s"),
    "break_even_frequency": Variable(
        (), "frequency above the peak where |a| reaches the least amplitude without the damper"),
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
    "maximum_displacement": Variable(
        ("frequency", "motion"), "largest displacement of the primary mass", "max |Z1|"),
    "asymmetry": Variable(
        ("frequency", "motion"), "distance of the motion from its mirror image half a period on"),
    "phase_relative": Variable(
        ("frequency", "motion"), "phase of Z1 to Z2, first harmonics", units="radian"),
    "phase_loose": Variable(
        ("frequency", "motion"), "phase of Z1 to Z1 - Z2, first harmonics", units="radian"),
    "multiplier_real": Variable(
        ("frequency", "motion"), "dominant Floquet multiplier, real part"),
    "multiplier_imaginary": Variable(
        ("frequency", "motion"), "dominant Floquet multiplier, imaginary part"),
    "residual": Variable(("frequency", "motion"), "distance of the state from its return"),
    "lyapunov_exponent": Variable(
        ("frequency", "motion"), "largest Lyapunov exponent per unit time"),
    "lyapunov_error": Variable(
        ("frequency", "motion"), "standard error of the largest Lyapunov exponent"),
    "periods_run": Variable(("frequency", "motion"), "forcing periods run before it settled"),
    # frequency responses
    "branch": Variable(("frequency", "motion"), "number of the branch a motion belongs to"),
    "share": Variable(("frequency", "motion"), "random starts that lead to the motion"),
    "origin": Variable(("frequency", "motion"), "how the motion was found first",
                       flags={"absent": 0, "random_start": 1, "followed": 2}),
    "run_outcome": Variable(("frequency", "start"), "what a random start came to", flags=OUTCOME),
    "run_length": Variable(("frequency", "start"), "forcing periods run from a random start"),
    "end_value": Variable(("end",), "parameter of the sweep at the end of a branch"),
    "end_branch": Variable(("end",), "branch that ends"),
    "end_direction": Variable(("end",), "direction of the sweep in which the branch ends",
                              flags={"down": -1, "up": 1}),
    "end_event": Variable(("end",), "what ends the branch", flags={
        "not_smooth": 0, "fold": 1, "symmetry_breaking": 2, "period_doubling": 3,
        "neimark_sacker": 4}),
    "end_displacement": Variable(
        ("end",), "largest displacement of the primary mass at the end of a branch"),
    "end_multiplier_real": Variable(("end",), "dominant Floquet multiplier there, real part"),
    "end_multiplier_imaginary": Variable(
        ("end",), "dominant Floquet multiplier there, imaginary part"),
    # first collisions
    "ball": Variable(("ball",), "where random starts were drawn"),
    "beyond_wall": Variable(("ball",), "share of starts that lie beyond a wall"),
    "colliding": Variable(("ball",), "share of starts that lead to a collision"),
    "longest_wait": Variable(("ball",), "longest wait for the first collision, forcing periods"),
}
