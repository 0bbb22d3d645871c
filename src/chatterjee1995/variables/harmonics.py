"""Harmonic balance with many harmonics and Hill's method, compared with the exact orbit."""

from impact_damper.data.variables.variable import Variable

COUNTED, ERRORS = ("highest_harmonic",), ("error_measure",)
EXPONENTS = ("highest_harmonic", "exponent")
SEARCH = {"converged": 0, "stalled": 1, "iteration_limit": 2}

VARIABLES = {
    "highest_harmonic": Variable(COUNTED, "highest harmonic", "N"),
    "error_measure": Variable(ERRORS, "quantity whose error is listed"),
    "series_status": Variable(
        COUNTED,
        "how Newton's method ended when started from the solution with fewer harmonics",
        flags=SEARCH,
    ),
    "series_steps": Variable(COUNTED, "number of steps of Newton's method"),
    "series_residual": Variable(COUNTED, "largest residual of the balance", quantity="mixed"),
    "series_maximum": Variable(
        COUNTED,
        "largest displacement by harmonic balance",
        "max |Z1|",
        quantity="displacement",
    ),
    "series_error": Variable(
        (*ERRORS, *COUNTED),
        "difference from the exact orbit: of max |Z1|, and of Z1 in the harmonics up to N and "
        "beyond N (root mean square), divided by max |Z1|; and of a Floquet multiplier",
    ),
    "cold_status": Variable(
        COUNTED,
        "how Newton's method ended when started from the single-term solution",
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
        COUNTED,
        "sum of the exponents by Hill's method minus the sum by Liouville's theorem",
        quantity="rate",
    ),
    "exact_status": Variable(
        (), "whether the exact orbit was found", flags={"not_found": 0, "found": 1}
    ),
    "exact_residual": Variable(
        (),
        "distance between the state of the exact orbit and the state a period later",
        quantity="mixed",
    ),
    "exact_maximum": Variable(
        (), "largest displacement of the exact orbit", "max |Z1|", quantity="displacement"
    ),
    "exact_multiplier_real": Variable(("exponent",), "exact Floquet multiplier, real part"),
    "exact_multiplier_imaginary": Variable(
        ("exponent",), "exact Floquet multiplier, imaginary part"
    ),
    "asymptotic_harmonic": Variable(
        (), "lowest N whose errors are used in the fit of the decrease"
    ),
    "decay_kind": Variable(
        (),
        "decrease of the errors: a power of N, or exponential",
        flags={"algebraic": 0, "exponential": 1},
    ),
    "decay_observed": Variable(
        ERRORS, "fitted power of 1/N, or rate per harmonic, at which an error decreases"
    ),
    "decay_fitted": Variable(ERRORS, "number of errors used in the fit"),
    "decay_predicted": Variable(ERRORS, "predicted power of 1/N, or rate per harmonic"),
}
