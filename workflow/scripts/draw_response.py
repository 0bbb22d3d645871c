"""Responses with and without the damper: figures 5, 8 and 10."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.response import draw_response
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_response(
    response=[load(path) for path in snakemake.input.response],
    design=[load(path) for path in snakemake.input.design],
    subharmonic=[load(path) for path in snakemake.input.subharmonic],
    branches=[load(path) for path in snakemake.input.branches],
    free_branches=[load(path) for path in snakemake.input.free_branches],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
