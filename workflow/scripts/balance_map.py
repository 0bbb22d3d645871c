"""A map of the errors of harmonic balance over frequency and another parameter."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.balance_map import balance_map

job = Job(snakemake)
job.save(
    balance_map(
        job["parameter"],
        job.grid("values"),
        job.grid("frequency_ratios"),
        job["fixed"],
        settling=job.settling,
        **job.running,
    )
)
