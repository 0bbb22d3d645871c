"""Rules for the clearance against the optimum of the motion."""

import sys
from pathlib import Path

from impact_damper.datasets import load
from impact_damper.figures.design_rules import draw_design_rules
from impact_damper.figures.style import save

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
drawing = draw_design_rules(
    design_rules=[load(path) for path in snakemake.input.design_rules],
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
