"""Maps of where harmonic balance fails."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.balance_map import draw_balance_map
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_balance_map(
    balance_map=[load(path) for path in snakemake.input.balance_map],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
