"""Chapter of the report: models and schemes."""

from impact_damper.workflow.registry.records import Kind

TITLE = "Models and schemes"
STAGES = ()
KINDS = (Kind("schematic", (), module="figures.schematics", most=1),)
TABLES = ()
