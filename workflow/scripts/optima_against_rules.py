"""Rules for the clearance against the optimum of the quiet motion, on a grid of dampers."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.datasets import save
from impact_damper.design_rules import design_rules
from impact_damper.parameters import Oscillator

job = ChainMap(*snakemake.params)
found = design_rules(
    Oscillator(**job["oscillator"]), *job["grid"], progress=snakemake.wildcards.grid
)
save(found, snakemake.output[0])
