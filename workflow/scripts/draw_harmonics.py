"""Errors of harmonic balance against the number of harmonics."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.harmonics import draw_harmonics
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_harmonics(
    harmonics=[load(path) for path in snakemake.input.harmonics],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
