"""Runs of the migration controller (section 5, figures 13 to 16)."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

from impact_damper.datasets import save
from impact_damper.ensemble import Settling
from impact_damper.migration import trials
from impact_damper.parameters import Damper, Oscillator

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
