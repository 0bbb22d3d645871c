"""Basins of attraction of motions without or with a damper (section 5 of the paper)."""

from chatterjee1995.workflow.job import Job
from impact_damper.orbits.basins import basins

job = Job(snakemake)
job.save(
    basins(
        job.oscillator,
        job.damper,
        job["frequency"],
        **job["plane"],
        settling=job.settling,
        **job.running,
    )
)
