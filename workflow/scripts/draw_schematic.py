"""Schematics: figures 1, 9, 12, 17 and B1."""

import sys
from pathlib import Path

from impact_damper.figures import schematics
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
(name,) = snakemake.params.data
save(getattr(schematics, name)(), Path(snakemake.output.pdf).with_suffix(""))
