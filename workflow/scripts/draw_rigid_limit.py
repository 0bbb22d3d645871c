"""Error of rigid impacts over contact stiffness and frequency."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.rigid_limit import draw_rigid_limit
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_rigid_limit(
    rigid_limit=[load(path) for path in snakemake.input.rigid_limit],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
