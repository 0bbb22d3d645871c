"""Rigid impacts against compliant contact over frequency and contact stiffness."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.rigid_limit import rigid_limit
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
limit = rigid_limit(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    job["frequency"],
    np.linspace(*job["frequencies"]),
    np.geomspace(*job["stiffnesses"]),
    starts=job["starts"],
    seed=job["seed"],
    settling=Settling(**job["settling"]),
)
save(limit, snakemake.output[0])
