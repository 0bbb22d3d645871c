"""Largest displacement against clearance: figures 6, 7 and 11."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.optimum import draw_optimum
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_optimum(
    optimum=[load(path) for path in snakemake.input.optimum],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
