"""The one-third subharmonic, and what the damper makes of it (figures 5 and 8)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.subharmonic import subharmonic_suppression
from impact_damper.system.parameters import Damper, Oscillator

job = ChainMap(*snakemake.params)
motions = subharmonic_suppression(
    Oscillator(**job["oscillator"]),
    Damper(**job["damper"]),
    np.linspace(*job["frequencies"]),
    **job["search"],
    settling=Settling(**job["settling"]),
    workers=snakemake.threads,
    progress=snakemake.wildcards.curve,
)
save(motions, snakemake.output[0])
