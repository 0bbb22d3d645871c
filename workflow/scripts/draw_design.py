"""Responses by harmonic balance: figure 3."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.design import draw_design
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_design(
    design=[load(path) for path in snakemake.input.design],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
