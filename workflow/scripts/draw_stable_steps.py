"""What becomes of the quiet motion with fixed steps."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.stable_steps import draw_stable_steps
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_stable_steps(
    stable_steps=[load(path) for path in snakemake.input.stable_steps],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
