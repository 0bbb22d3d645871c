"""The contact model over restitution and load."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.contact_model import draw_contact_model
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_contact_model(
    contact_model=[load(path) for path in snakemake.input.contact_model],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
