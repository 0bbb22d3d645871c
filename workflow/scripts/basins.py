"""Basins of attraction of the motions without a damper and with one (section 5)."""

from impact_damper.workflow.job import Job
from impact_damper.stages.basins import basins

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
