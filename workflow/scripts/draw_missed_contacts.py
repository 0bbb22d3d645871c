"""Contacts near grazing that integrators miss."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.missed_contacts import draw_missed_contacts
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_missed_contacts(
    missed_contacts=[load(path) for path in snakemake.input.missed_contacts],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
