"""Free response: figure 2."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.free import draw_free
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_free(
    free_branches=[load(path) for path in snakemake.input.free_branches],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
