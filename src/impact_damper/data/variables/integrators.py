"""Failures of integrators: contacts missed near grazing, unstable steps, wrong verdicts.

A passage is a free flight past a wall placed close to its largest |Z2| (`rivals.passages`). A scene
is a test case: a motion of which is known whether it settles on a certain orbit. The verdict of a
method on a scene says whether the method finds that.
"""

from impact_damper.data.variables.variable import Variable

STEP_VERDICT = {
    "no_orbit": -2,
    "not_run": -1,
    "within_1_percent": 0,
    "within_10_percent": 1,
    "off": 2,
    "escaped": 3,
    "diverged": 4,
}
VERDICT = {
    "not_run": -1,
    "right": 0,
    "not_settled": 1,
    "wrong_period": 2,
    "wrong_branch": 3,
    "stays_wrongly": 4,
    "failed": 5,
}

VARIABLES = {
    "integrator": Variable(("integrator",), "method of integration"),
    "method_tolerance": Variable(("method_tolerance",), "tolerance of the method"),
    # contacts missed near grazing
    "depth": Variable(("depth",), "distance by which a passage without wall would go beyond it"),
    "contact_outcome": Variable(("contact_outcome",), "how a method treats a contact"),
    "passage_count": Variable(
        ("integrator", "method_tolerance", "depth", "contact_outcome"),
        "number of contacts that a method finds, passes between two steps, or does not reach since "
        "its motion is inaccurate, and number of failed runs",
    ),
    "spurious_count": Variable(
        ("integrator", "method_tolerance", "depth"),
        "number of contacts that a method reports in passages without contact",
    ),
    "mean_steps": Variable(
        ("integrator", "method_tolerance"),
        "mean number of steps per cycle in flight, failed runs excluded",
    ),
    "motion_error": Variable(
        ("integrator", "method_tolerance"),
        "median error of the largest |Z2| of a passage, failed runs excluded",
    ),
    "passages": Variable(("integrator",), "number of passages run for each tolerance"),
    "passages_drawn": Variable((), "number of random flights among which the passages were chosen"),
    "fixed_steps": Variable(("method_tolerance",), "steps per cycle of the fixed-step method"),
    "expected_unseen": Variable(
        ("method_tolerance", "depth"),
        "expected share of contacts that lie between two ends of fixed steps, at random times",
    ),
    "extremum_time": Variable(("passage",), "time of the largest |Z2| of a passage", "T"),
    "extremum": Variable(("passage",), "largest |Z2| of a passage"),
    "extremum_curvature": Variable(("passage",), "|Z2''| at the largest |Z2| of a passage"),
    # largest stable steps
    "fixed_method": Variable(("fixed_method",), "method with equal steps"),
    "scaled_step": Variable(("scaled_step",), "step times contact frequency", "h omega_c"),
    "accuracy": Variable(("accuracy",), "relative deviation allowed in max |Z1|"),
    "step_verdict": Variable(
        ("fixed_method", "contact_stiffness", "scaled_step"),
        "how closely the method stays on the quiet motion",
        flags=STEP_VERDICT,
    ),
    "step_deviation": Variable(
        ("fixed_method", "contact_stiffness", "scaled_step"),
        "largest relative deviation of max |Z1| in any period, infinite if the run diverged",
    ),
    "steps_per_period": Variable(("contact_stiffness", "scaled_step"), "steps per cycle"),
    "stable_step": Variable(
        ("fixed_method", "contact_stiffness", "accuracy"),
        "largest step such that this step and all smaller ones keep the accuracy",
        "h",
    ),
    "largest_holding_step": Variable(
        ("fixed_method", "contact_stiffness", "accuracy"),
        "largest step that keeps the accuracy",
        "h",
    ),
    "step_slope": Variable(
        ("fixed_method", "accuracy"),
        "slope of log(1/h) as a function of log r1, h the largest stable step",
    ),
    "step_slope_error": Variable(("fixed_method", "accuracy"), "standard error of step_slope"),
    "linear_limit": Variable(
        ("fixed_method",),
        "largest product of step and contact frequency by linear stability theory",
    ),
    "contact_frequency": Variable(
        ("contact_stiffness",), "natural frequency of an undamped contact", "omega_c"
    ),
    "reference_displacement": Variable(
        ("contact_stiffness",), "largest displacement of the exact orbit", "max |Z1|"
    ),
    "orbit_multiplier": Variable(
        ("contact_stiffness",), "modulus of the dominant Floquet multiplier of the exact orbit"
    ),
    "free_bound": Variable((), "displacement beyond which a run has escaped", "max |Z1|"),
    # verdicts by tolerance
    "scene": Variable(
        ("scene",), "test case: motion of which is known whether it settles on an orbit"
    ),
    "verdict_method": Variable(("verdict_method",), "method of integration"),
    "verdict": Variable(
        ("scene", "verdict_method", "method_tolerance"),
        "verdict of the method, and how it is wrong",
        flags=VERDICT,
    ),
    "right_from": Variable(
        ("scene", "verdict_method"),
        "largest tolerance, or smallest number of steps, such that it and all stricter ones give "
        "the right verdict",
    ),
    "verdict_steps": Variable(("method_tolerance",), "steps per cycle of fixed-step methods"),
    "scene_multiplier": Variable(
        ("scene",), "modulus of the dominant Floquet multiplier of the orbit"
    ),
    "scene_period": Variable(("scene",), "period of the orbit in cycles", "n"),
    "landing_period": Variable(
        ("scene",), "period of the motion that results, 0 if it does not settle", "n"
    ),
    "scene_periods": Variable(("scene",), "number of cycles of a run"),
    "scene_frequency": Variable(("scene",), "forcing frequency", "Omega"),
    "scene_truth": Variable(
        ("scene",),
        "whether the motion settles on the orbit",
        flags={"leaves": 0, "stays": 1},
    ),
}
