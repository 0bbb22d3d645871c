"""A study over mass ratio, clearance, frequency and restitution, joined from its chunks.

If the study is not divided into chunks, this script computes it as a single chunk.
"""

from tempfile import TemporaryDirectory

import numpy as np

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.studies import study_chunk
from chatterjee1995.stages.study_grid import gather_chunks
from impact_damper.data.datasets import save

job = Job(snakemake)
chunks = list(snakemake.input.chunks)
with TemporaryDirectory() as folder:
    if not chunks:
        chunk = study_chunk(
            job.oscillator,
            {name: np.linspace(*ends) for name, ends in job["axes"].items()},
            job["cells"],
            contact_stiffness=job["contact_stiffness"],
            **job["search"],
            settling=job.settling,
            **job.running,
        )
        chunks = [f"{folder}/1-of-1.nc"]
        save(chunk, chunks[0])
    gather_chunks(chunks, job.output)
