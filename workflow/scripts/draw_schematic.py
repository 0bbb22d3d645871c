"""Schematics: figures 1, 9, 12, 17 and B1."""

from impact_damper.workflow.job import begin

begin(snakemake)

from pathlib import Path

from impact_damper.figures import schematics
from impact_damper.figures.style import save

(name,) = snakemake.params.data
save(getattr(schematics, name)(), Path(snakemake.output.pdf).with_suffix(""))
