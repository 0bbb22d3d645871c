"""A chunk of a study over mass ratio, clearance, frequency and restitution."""

from impact_damper.workflow.job import begin

begin(snakemake)

from collections import ChainMap

import numpy as np

from impact_damper.data.datasets import save
from impact_damper.motions.ensemble import Settling
from impact_damper.stages.studies import study_chunk
from impact_damper.system.parameters import Oscillator

job = ChainMap(*snakemake.params)
chunk = study_chunk(
    Oscillator(**job["oscillator"]),
    {name: np.linspace(*ends) for name, ends in job["axes"].items()},
    job["cells"],
    contact_stiffness=job["contact_stiffness"],
    **job["search"],
    settling=Settling(**job["settling"]),
    workers=snakemake.threads,
    progress=snakemake.wildcards.study,
)
save(chunk, snakemake.output[0])
