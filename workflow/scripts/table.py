"""Tables of designs, bands, optima, subharmonics, migration, releases and maps."""

import sys
from pathlib import Path

from impact_damper import balance_map_table, tables
from impact_damper.datasets import load
from impact_damper.table_files import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
datasets = {
    stage: {Path(path).stem: load(path) for path in paths}
    for stage, paths in snakemake.input.items()
    if stage != "code"
}
table = snakemake.wildcards.table
make = getattr({"balance_map": balance_map_table}.get(table, tables), table)
save(make(datasets), snakemake.output.csv, snakemake.output.markdown)
