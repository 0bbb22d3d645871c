"""Rules for the clearance against the optimum of the quiet motion, on a grid of dampers."""

import sys
from collections import ChainMap

from impact_damper.datasets import save
from impact_damper.design_rules import design_rules
from impact_damper.parameters import Oscillator

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
job = ChainMap(*snakemake.params)
found = design_rules(
    Oscillator(**job["oscillator"]), *job["grid"], progress=snakemake.wildcards.grid
)
save(found, snakemake.output[0])
