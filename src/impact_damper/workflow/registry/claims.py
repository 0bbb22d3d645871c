"""Chapter of the report: claims of the paper."""

from impact_damper.workflow.registry.records import Table

TITLE = "Claims of the paper"
STAGES = ()
KINDS = ()
TABLES = (
    Table(
        "readings",
        "tables.accuracy",
        ("harmonic_balance", "branches", "response", "optimum"),
        "Optimum clearances and band edges as each model gives them, against the motions that "
        "exist.",
    ),
    Table(
        "claims",
        "claims.verdicts",
        (
            "harmonic_balance",
            "design_orbit",
            "branches",
            "response",
            "motion",
            "collisions",
            "optimum",
            "subharmonic",
            "migration",
            "release_scan",
        ),
        "Every claim of the paper, the number that decides it, our reading where it is vague, "
        "and the verdict computed from the data.",
    ),
)
