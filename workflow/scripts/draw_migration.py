"""Displacement against time under migration control: figures 13, 15 and 16."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.migration import draw_migration
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_migration(
    migration=[load(path) for path in snakemake.input.migration],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
