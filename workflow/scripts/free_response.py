"""Motions of the free oscillator and the ends of its branches (figure 2)."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.response import frequency_response
from impact_damper.system.parameters import Oscillator

job = ChainMap(*snakemake.params)
response = frequency_response(
    Oscillator(**job["oscillator"]),
    None,
    np.linspace(*job["frequencies"]),
    **job["search"],
    settling=Settling(**job["settling"]),
    workers=snakemake.threads,
    progress=snakemake.wildcards.oscillator,
)
save(response, snakemake.output[0])
