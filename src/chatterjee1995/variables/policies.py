"""Policies of migration, rules that say when to switch the damper off, and their success.

Migration leads the motion from the resonance to the goal, the small motion without damper, by
switching the damper on and off. The release set holds the states from which the motion reaches the
goal after the damper is switched off.
"""

from impact_damper.data.variables.variable import Variable

CASE = ("case", "frequency")
DAMPER = ("frequency", "restitution", "mass_ratio", "clearance")
DISTURBED = ("case", "noisy_frequency", "disturbance", "margin")

VARIABLES = {
    "case": Variable(("case",), "index of a damper"),
    "policy": Variable(("policy",), "policy by which the damper is switched off"),
    "quantile": Variable(("quantile",), "quantile over all trials"),
    "margin": Variable(
        ("margin",),
        "least distance of the state from the edge of the goal's basin, over the size of the "
        "resonance motion",
    ),
    "noisy_frequency": Variable(
        ("noisy_frequency",),
        "forcing frequency at which disturbances are studied",
        "Omega",
        quantity="frequency",
    ),
    "disturbance": Variable(
        ("disturbance",),
        "error of the measured state over the size of the resonance motion, delay in "
        "cycles, or errors of the damping and the force that the controller assumes",
    ),
    "case_mass_ratio": Variable(("case",), "mass ratio of a damper", "rm"),
    "case_clearance": Variable(("case",), "clearance of a damper", "d0", quantity="clearance"),
    "case_restitution": Variable(("case",), "coefficient of restitution of a damper", "e"),
    "policy_success": Variable(
        (*CASE, "policy", "bound"), "share of trials that reach the goal within 350 cycles"
    ),
    "policy_cycles": Variable(
        (*CASE, "policy", "quantile", "bound"),
        "cycles until the motion has settled on the goal, infinite without success",
    ),
    "policy_damper": Variable(
        (*CASE, "policy", "bound"), "median of the cycles with the damper on"
    ),
    "policy_impacts": Variable((*CASE, "policy", "bound"), "median of the impacts"),
    "policy_releases": Variable((*CASE, "policy"), "mean number of releases"),
    "policy_hold": Variable(
        (*CASE, "policy"),
        "cycles for which the policy keeps the damper on; for release by state, at most",
    ),
    "policy_phase": Variable(
        (*CASE, "policy"), "phase Omega T of the release that the policy chose", units="radian"
    ),
    "predicted_share": Variable(
        (*CASE, "bound"), "share of releases that the release set predicts to reach the goal"
    ),
    "realised_share": Variable(
        (*CASE, "bound"), "share of the same releases that do reach the goal"
    ),
    "agreeing_share": Variable(
        (*CASE, "bound"), "share of these releases for which the prediction is right"
    ),
    "least_impulse": Variable(
        ("frequency",),
        "least change of velocity that leads from the resonance to the goal, at the best phase",
        quantity="velocity",
    ),
    "median_impulse": Variable(
        ("frequency",),
        "median over phases of the least change of velocity that leads to the goal",
        quantity="velocity",
    ),
    "disturbed_success": Variable(
        (*DISTURBED, "bound"), "share of trials that reach the goal in spite of a disturbance"
    ),
    "disturbed_cycles": Variable(
        (*DISTURBED, "bound"),
        "median of the cycles until the goal in spite of a disturbance",
    ),
    # of the stage release_dampers; along a cut only the restitution of the damper varies
    "cut_restitution": Variable(("cut_restitution",), "coefficient of restitution", "e"),
    "resonance_displacement": Variable(
        ("frequency",), "max |Z1| of the free resonance motion", quantity="displacement"
    ),
}

for part, dims in {"damper": DAMPER, "cut": ("frequency", "cut_restitution")}.items():
    VARIABLES |= {
        f"{part}_success": Variable(
            (*dims, "policy", "bound"), "share of trials that reach the goal within 350 cycles"
        ),
        f"{part}_cycles": Variable(
            (*dims, "policy", "bound"), "median of the cycles until the goal"
        ),
        f"{part}_quiet": Variable(
            dims,
            "max |Z1| of the smallest periodic motion with the damper on, if it is below half of "
            "resonance_displacement",
            quantity="displacement",
        ),
        f"{part}_largest": Variable(
            dims, "largest max |Z1| of the motions with the damper on", quantity="displacement"
        ),
    }
