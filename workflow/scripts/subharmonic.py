"""Runs from the one-third subharmonic with the damper switched on (paper: figures 5 and 8)."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.subharmonic import subharmonic_suppression

job = Job(snakemake)
job.save(
    subharmonic_suppression(
        job.oscillator,
        job.damper,
        job.grid("frequencies"),
        **job["search"],
        settling=job.settling,
        **job.running,
    )
)
