"""Exact branches of orbits of free oscillators and dampers, with their bifurcations."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.orbits import draw_branches
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_branches(
    branches=[load(path) for path in snakemake.input.branches],
    free_branches=[load(path) for path in snakemake.input.free_branches],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
