"""Every table but that of the claims."""

import sys
from pathlib import Path

from impact_damper import (
    balance_map_table,
    contact_tables,
    harmonics_table,
    integrator_tables,
    orbit_tables,
    rule_tables,
    tables,
)
from impact_damper.datasets import load
from impact_damper.table_files import save

TABLES = {
    "design": tables.design,
    "bands": tables.bands,
    "optima": tables.optima,
    "subharmonics": tables.subharmonics,
    "migration": tables.migration,
    "releases": tables.releases,
    "orbits": orbit_tables.orbits,
    "bifurcations": orbit_tables.bifurcations,
    "harmonics": harmonics_table.harmonics,
    "design_rules": rule_tables.design_rules,
    "balance_map": balance_map_table.balance_map,
    "contact_model": contact_tables.contact_model,
    "contact_motions": contact_tables.contact_motions,
    "rigid_limit": contact_tables.rigid_limit,
    "grazing": integrator_tables.grazing,
    "steps": integrator_tables.steps,
    "verdicts": integrator_tables.verdicts,
}

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
datasets = {
    stage: {Path(path).stem: load(path) for path in paths}
    for stage, paths in snakemake.input.items()
    if stage != "code"
}
table = TABLES[snakemake.wildcards.table](datasets)
save(table, snakemake.output.csv, snakemake.output.markdown)
