"""Every table but that of the claims: the function of its name, in the module that makes it."""

from impact_damper.workflow.job import begin

begin(snakemake)

from importlib import import_module
from pathlib import Path

from impact_damper.data.datasets import load
from impact_damper.data.table_files import save

datasets = {
    stage: {Path(path).stem: load(path) for path in paths}
    for stage, paths in snakemake.input.items()
    if stage != "code"
}
make = getattr(import_module(snakemake.params.module), snakemake.wildcards.table)
save(make(datasets), snakemake.output.csv, snakemake.output.markdown)
