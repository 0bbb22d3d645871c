"""Runs of the migration controller (section 5, figures 13 to 16)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.migration import trials
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
outcome = trials(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    job["frequency"],
    **job["controller"],
    seed=job["seed"],
    settling=Settling(**job["settling"]),
    workers=snakemake.threads,
    progress=snakemake.wildcards.run,
)
save(outcome, snakemake.output[0])
