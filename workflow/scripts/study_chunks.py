"""A chunk of a study over mass ratio, clearance, frequency and restitution."""

import numpy as np

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.studies import study_chunk

job = Job(snakemake)
job.save(
    study_chunk(
        job.oscillator,
        {name: np.linspace(*ends) for name, ends in job["axes"].items()},
        job["cells"],
        contact_stiffness=job["contact_stiffness"],
        **job["search"],
        settling=job.settling,
        **job.running,
    )
)
