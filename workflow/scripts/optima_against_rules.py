"""Rules for the clearance against the optimum of the quiet motion, on a grid of dampers."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.data.datasets import save
from impact_damper.stages.design_rules import design_rules
from impact_damper.system.parameters import Oscillator

job = ChainMap(*snakemake.params)
found = design_rules(
    Oscillator(**job["oscillator"]), *job["grid"], progress=snakemake.wildcards.grid
)
save(found, snakemake.output[0])
