"""Published numbers compared with numbers computed by this package."""

from impact_damper.workflow.job import Job
from impact_damper.stages.published import published

job = Job(snakemake)
job.save(published(job["settings"], seed=job["seed"], settling=job.settling))
