"""Every table but that of the claims."""
"""Tables of all but the claims."""
"""Tables of designs, bands, optima, rules, subharmonics, migration and releases."""
"""Tables of designs, bands, optima, subharmonics, migration, releases and harmonics."""
"""Tables of the results, and of where integrators fail."""
"""Tables of designs, bands, optima, subharmonics, migration, releases and maps."""

import sys
from pathlib import Path

from impact_damper import orbit_tables, tables
from impact_damper import contact_tables, tables
from impact_damper import rule_tables, tables
from impact_damper import harmonics_table, tables
from impact_damper import integrator_tables, tables
from impact_damper import balance_map_table, tables
from impact_damper.datasets import load
from impact_damper.table_files import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
datasets = {
    stage: {Path(path).stem: load(path) for path in paths}
    for stage, paths in snakemake.input.items()
    if stage != "code"
}
name = snakemake.wildcards.table
make = next(getattr(module, name) for module in (tables, orbit_tables) if hasattr(module, name))
make = getattr(contact_tables if hasattr(contact_tables, name) else tables, name)
make = getattr({"design_rules": rule_tables}.get(name, tables), name)
table = snakemake.wildcards.table
make = getattr({"harmonics": harmonics_table}.get(table, tables), table)
make = getattr(tables if hasattr(tables, name) else integrator_tables, name)
table = snakemake.wildcards.table
make = getattr({"balance_map": balance_map_table}.get(table, tables), table)
save(make(datasets), snakemake.output.csv, snakemake.output.markdown)
