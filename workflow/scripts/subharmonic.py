"""Runs from the one-third subharmonic with the damper switched on (paper: figures 5 and 8)."""

from impact_damper.workflow.job import Job
from impact_damper.stages.subharmonic import subharmonic_suppression

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
