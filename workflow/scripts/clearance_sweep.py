"""Largest displacement against clearance, and its optimum (figures 6, 7 and 11)."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.datasets import save
from impact_damper.ensemble import Settling
from impact_damper.optimum import clearance_sweep
from impact_damper.parameters import Oscillator

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
