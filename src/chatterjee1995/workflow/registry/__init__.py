"""The registry: one record for each stage, table and kind of figure, by chapter of the report.

A stage is a step of the workflow that makes a dataset for each entry of a section of the
configuration.
Rules, targets, scripts, the checks of the configuration and the tests take their lists from here.
Every dry run imports the registry, so it must not import modules that load slowly.
"""

from chatterjee1995.workflow.registry import (
    claims,
    clearance,
    design,
    machines,
    methods,
    migration,
    responses,
)

# Chapters of the report. One job draws the figures and makes the tables of a chapter.
CHAPTERS = {
    "design": design,
    "responses": responses,
    "clearance": clearance,
    "migration": migration,
    "methods": methods,
    "claims": claims,
    "machines": machines,
}
# Chapters of the paper, which `snakemake` without a target makes.
PAPER = [name for name, chapter in CHAPTERS.items() if all(stage.paper for stage in chapter.STAGES)]
STAGES = {stage.name: stage for chapter in CHAPTERS.values() for stage in chapter.STAGES}
KINDS = {kind.name: kind for chapter in CHAPTERS.values() for kind in chapter.KINDS}
TABLES = {table.name: table for chapter in CHAPTERS.values() for table in chapter.TABLES}


def section_of(kind) -> str | None:
    """Return the section whose entries a kind of figure draws; None for schematics."""
    stages = KINDS[kind].stages
    return STAGES[stages[0]].section if stages else None
