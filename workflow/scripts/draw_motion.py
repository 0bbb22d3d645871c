"""Phase plots: figure 4."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.motion import draw_motion
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_motion(
    motion=[load(path) for path in snakemake.input.motion],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
