"""Where harmonic balance fails, over frequency and another parameter."""

from impact_damper.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.balance_map import balance_map
from impact_damper.datasets import save
from impact_damper.ensemble import Settling

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
