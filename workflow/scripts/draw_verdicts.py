"""Verdicts of integrators against the truth."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.style import save
from impact_damper.figures.verdicts import draw_verdicts

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_verdicts(
    verdicts=[load(path) for path in snakemake.input.verdicts],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
