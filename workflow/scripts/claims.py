"""The claims table: every claim of the paper, the number that decides it, and the verdict."""

from impact_damper.workflow.job import begin

begin(snakemake)

from pathlib import Path

from impact_damper.claims.verdicts import claims, document
from impact_damper.data.datasets import load
from impact_damper.data.table_files import save

datasets = {
    stage: {Path(path).stem: load(path) for path in paths}
    for stage, paths in snakemake.input.items()
    if stage != "code"
}
save(claims(datasets), snakemake.output.csv, snakemake.output.markdown, document)
