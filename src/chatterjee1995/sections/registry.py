"""All stages, kinds of figures and tables. Dry runs import this module, so it must load fast."""

from chatterjee1995.sections import balance, clearance, curves, machines, methods, migration
from chatterjee1995.sections.records import Kind, Stage, Table

SCHEMATIC = Kind("schematic", "design", "schematics", (), most=1)
CLAIMED = (
    "harmonic_balance design_orbit branches response motion collisions optimum subharmonic "
    "migration release_scan release_policies"
).split()
VERDICTS = "chatterjee1995.claims.verdicts"
CLAIMS = (Table("claims", "claims", VERDICTS, tuple(CLAIMED), pictures=True),)
SUBJECTS = (curves, balance, clearance, migration, methods, machines)
# Chapters of the report with their titles. One job makes all figures and tables of a chapter.
CHAPTERS = {
    "design": "Models and harmonic balance",
    "responses": "Frequency responses",
    "clearance": "Optimum clearance",
    "migration": "Migration control",
    "methods": "Methods compared",
    "claims": "Claims of the paper",
    "machines": "Dampers for machines in SI units",
}
SECTIONS = {name: model for subject in SUBJECTS for name, model in subject.SECTIONS.items()}
STAGES = {
    job.stage["name"]: Stage(section=section, job=job, **job.stage)
    for section, model in SECTIONS.items()
    for job in vars(model).values()
    if hasattr(job, "stage")
}
KINDS = {kind.name: kind for each in SUBJECTS for kind in each.KINDS} | {"schematic": SCHEMATIC}
TABLES = {table.name: table for each in SUBJECTS for table in (*each.TABLES, *CLAIMS)}


def section_of(kind) -> str | None:
    """Return the section whose entries a kind of figure draws; None for schematics."""
    stages = KINDS[kind].stages
    return STAGES[stages[0]].section if stages else None


def is_paper(chapter) -> bool:
    """Return whether `paper` is true for every stage whose data a chapter of the report shows."""
    shown = [each for each in (*KINDS.values(), *TABLES.values()) if each.chapter == chapter]
    return all(STAGES[stage].paper for each in shown for stage in each.stages)


PAPER = [chapter for chapter in CHAPTERS if is_paper(chapter)]
