"""Tables of the results, and of where integrators fail."""

import sys
from pathlib import Path

from impact_damper import integrator_tables, tables
from impact_damper.datasets import load
from impact_damper.table_files import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
datasets = {
    stage: {Path(path).stem: load(path) for path in paths}
    for stage, paths in snakemake.input.items()
    if stage != "code"
}
name = snakemake.wildcards.table
make = getattr(tables if hasattr(tables, name) else integrator_tables, name)
save(make(datasets), snakemake.output.csv, snakemake.output.markdown)
