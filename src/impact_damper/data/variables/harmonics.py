"""Harmonic balance with many harmonics against the exact orbit, and Hill's method."""

from impact_damper.data.variables.variable import Variable

COUNTED, ERRORS = ("highest_harmonic",), ("error_measure",)
EXPONENTS = ("highest_harmonic", "exponent")
SEARCH = {"converged": 0, "stalled": 1, "iteration_limit": 2}

VARIABLES = {
    "highest_harmonic": Variable(COUNTED, "highest harmonic", "N"),
    "error_measure": Variable(ERRORS, "what an error is an error of"),
    "series_status": Variable(
        COUNTED, "how Newton's method ended, begun from fewer harmonics", flags=SEARCH
    ),
    "series_steps": Variable(COUNTED, "steps of Newton's method"),
    "series_residual": Variable(COUNTED, "largest residual of the balance"),
    "series_maximum": Variable(COUNTED, "largest displacement by harmonic balance", "max |Z1|"),
    "series_error": Variable(
        (*ERRORS, *COUNTED),
        "error against the exact orbit: of max |Z1|, of Z1 in the mean square of the harmonics up "
        "to N and beyond, as shares of max |Z1|; of a Floquet multiplier",
    ),
    "cold_status": Variable(
        COUNTED,
        "what Newton's method came to, begun from the single-term solution",
        flags={
            "not_tried": -1,
            "same_motion": 0,
            "stalled": 1,
            "iteration_limit": 2,
            "another_motion": 3,
        },
    ),
    "hill_status": Variable(
        COUNTED,
        "how Hill's method ended",
        flags={"not_tried": -1, "found": 0, "not_separated": 1, "not_converged": 2},
    ),
    "hill_multiplier_real": Variable(EXPONENTS, "Floquet multiplier by Hill's method, real part"),
    "hill_multiplier_imaginary": Variable(
        EXPONENTS, "Floquet multiplier by Hill's method, imaginary part"
    ),
    "hill_trace_error": Variable(
        COUNTED, "sum of the exponents by Hill's method, less that of Liouville's theorem"
    ),
    "exact_status": Variable(
        (), "whether the exact orbit was found", flags={"not_found": 0, "found": 1}
    ),
    "exact_residual": Variable((), "distance of the exact orbit's state from its return"),
    "exact_maximum": Variable((), "largest displacement of the exact orbit", "max |Z1|"),
    "exact_multiplier_real": Variable(("exponent",), "exact Floquet multiplier, real part"),
    "exact_multiplier_imaginary": Variable(
        ("exponent",), "exact Floquet multiplier, imaginary part"
    ),
    "asymptotic_harmonic": Variable((), "harmonic from which on errors are fitted"),
    "decay_kind": Variable(
        (),
        "how errors fall: by a power of N, or exponentially",
        flags={"algebraic": 0, "exponential": 1},
    ),
    "decay_observed": Variable(
        ERRORS, "power of 1/N, or rate per harmonic, by which an error falls, fitted"
    ),
    "decay_fitted": Variable(ERRORS, "number of errors fitted"),
    "decay_predicted": Variable(ERRORS, "power of 1/N, or rate per harmonic, predicted"),
}
