"""Motions over frequency, from random starts (paper: figures 2, 5, 8 and 10)."""

from chatterjee1995.workflow.job import Job
from impact_damper.motions.response import frequency_response

job = Job(snakemake)
job.save(
    frequency_response(
        job.oscillator,
        job.damper,
        job.grid("frequencies"),
        **job["search"],
        **job["lives"],
        settling=job.settling,
        **job.running,
    )
)
