"""Motions that follow when the damper is switched off, over frequency (paper: figure 14)."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.release_scan import release_scan

job = Job(snakemake)
job.save(
    release_scan(
        job.oscillator,
        job.damper,
        job.grid("frequencies"),
        **job["search"],
        releases=job["releases"],
        lifetime=job["lifetime"],
        settling=job.settling,
        **job.running,
    )
)
