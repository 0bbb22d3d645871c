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
        "Optimum clearances and band edges by each model, compared with the motions that exist.",
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
            "release_policies",
        ),
        "Every claim of the paper, with its interpretation, the measures that decide it, and the "
        "verdict computed from the data.",
    ),
)
