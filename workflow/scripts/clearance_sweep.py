"""Largest displacement against clearance, and its optimum (figures 6, 7 and 11)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.optimum import clearance_sweep
from impact_damper.system.parameters import Oscillator

job = ChainMap(*snakemake.params)
sweep = clearance_sweep(
    Oscillator(**job["oscillator"]),
    job["damper"],
    job["frequency"],
    np.linspace(*job["clearances"]),
    **job["search"],
    settling=Settling(**job["settling"]),
    workers=snakemake.threads,
    progress=snakemake.wildcards.optimum,
)
save(sweep, snakemake.output[0])
