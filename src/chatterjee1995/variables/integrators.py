"""Failures of integrators: contacts missed near grazing, unstable steps, wrong verdicts.

A passage is a random flight of the loose mass, computed without walls (`rivals.passages`). As a
test case, a wall is placed close to the largest |Z2| of the flight. A scene is another test case: a
motion and an orbit, with the knowledge whether the motion settles on the orbit. The verdict on a
method says whether it finds the right answer.
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
    "depth": Variable(
        ("depth",), "distance by which a passage would go beyond the wall if it were not there"
    ),
    "contact_outcome": Variable(("contact_outcome",), "result of a method at a contact"),
    "passage_count": Variable(
        ("integrator", "method_tolerance", "depth", "contact_outcome"),
        "number of contacts that a method finds, misses between two steps, or does not reach "
        "because its motion is inaccurate, and number of failed runs",
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
        "expected share of contacts at random times that begin and end within one fixed step",
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
        "deviation of the method from the quiet motion",
        flags=STEP_VERDICT,
    ),
    "step_deviation": Variable(
        ("fixed_method", "contact_stiffness", "scaled_step"),
        "largest relative deviation of max |Z1| in any period, infinite if the run diverged",
    ),
    "steps_per_period": Variable(("contact_stiffness", "scaled_step"), "steps per cycle"),
    "stable_step": Variable(
        ("fixed_method", "contact_stiffness", "accuracy"),
        "largest step that keeps the accuracy together with all smaller ones",
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
    "scene": Variable(("scene",), "test case: a motion near an orbit of known stability"),
    "verdict_method": Variable(("verdict_method",), "method of integration"),
    "verdict": Variable(
        ("scene", "verdict_method", "method_tolerance"),
        "verdict on the method: right, or the kind of error",
        flags=VERDICT,
    ),
    "right_from": Variable(
        ("scene", "verdict_method"),
        "largest tolerance, or smallest number of steps, that gives the right verdict together "
        "with all stricter ones",
    ),
    "verdict_steps": Variable(("method_tolerance",), "steps per cycle of fixed-step methods"),
    "scene_multiplier": Variable(
        ("scene",), "modulus of the dominant Floquet multiplier of the orbit"
    ),
    "scene_period": Variable(("scene",), "period of the orbit in cycles", "n"),
    "landing_period": Variable(
        ("scene",), "period of the resulting motion, 0 if the motion does not settle", "n"
    ),
    "scene_periods": Variable(("scene",), "number of cycles of a run"),
    "scene_frequency": Variable(("scene",), "forcing frequency", "Omega"),
    "scene_truth": Variable(
        ("scene",),
        "whether the motion settles on the orbit",
        flags={"leaves": 0, "stays": 1},
    ),
}
