"""Chapter of the report: claims of the paper, judged by the data of the other chapters.

The suppression band is the range of frequencies without violent (large) motion.
"""

from chatterjee1995.workflow.registry.records import Table

TITLE = "Claims of the paper"
STAGES = ()
KINDS = ()
TABLES = (
    Table(
        "claims",
        "chatterjee1995.claims.verdicts",
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
        "Every claim of the paper with its interpretation, the numbers that decide it, and the "
        "verdict computed from them.",
        pictures=True,
    ),
)
