"""Where harmonic balance fails, over frequency and another parameter."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.balance_map import balance_map

job = ChainMap(*snakemake.params)
found = balance_map(
    job["parameter"],
    np.linspace(*job["values"]),
    np.linspace(*job["frequency_ratios"]),
    job["fixed"],
    settling=Settling(**job["settling"]),
    workers=snakemake.threads,
    progress=snakemake.wildcards.balance_map,
)
save(found, snakemake.output[0])
