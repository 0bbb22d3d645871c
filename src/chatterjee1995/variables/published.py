"""Published numbers, and the same quantities computed by this package."""

from impact_damper.data.variables.variable import Variable

EACH = ("comparison",)

VARIABLES = {
    "comparison": Variable(EACH, "quantity that is compared, with its parameters"),
    "publication": Variable(
        EACH,
        "publication of the number or of its closed form",
        flags={
            "masri_caughey": 0,
            "slow_manifold": 1,
            "den_hartog": 2,
            "nishihara_asami": 3,
            "habib": 4,
            "bstab": 5,
            "brennan": 6,
            "hertz": 7,
        },
    ),
    "published_value": Variable(EACH, "published number, or value of the published closed form"),
    "our_value": Variable(EACH, "number computed here"),
    "difference_reason": Variable(
        EACH,
        "why the numbers differ: finite contact stiffness, closed form of first order in the "
        "mass ratio, height of fixed points in place of peaks, tolerance of a direct search, "
        "closed form of first order in the force, random starts, closed form with one harmonic, "
        "linear contact",
        flags={
            "contact_stiffness": 0,
            "mass_ratio": 1,
            "fixed_points": 2,
            "direct_search": 3,
            "first_order": 4,
            "random_starts": 5,
            "one_harmonic": 6,
            "linear_contact": 7,
        },
    ),
    "difference_order": Variable(
        EACH,
        "exponent n of difference ~ parameter^n; difference_reason names the parameter",
    ),
    "difference_error": Variable(EACH, "standard error of the difference of two random counts"),
    "limit_value": Variable(EACH, "number computed here, extrapolated to rigid walls"),
    "expected_difference": Variable(
        EACH,
        "expected size of the relative difference: from the extrapolation to rigid walls, the mass "
        "ratio, 1.96 standard errors, or a linear contact; NaN if unknown",
    ),
}
