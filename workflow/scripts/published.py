"""Published numbers compared with numbers computed by this package."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.published import published

job = Job(snakemake)
job.save(published(job["settings"], seed=job["seed"], settling=job.settling))
