"""The exact quiet orbit at the peak frequency, followed in damping (figure 3)."""

from impact_damper.workflow.job import Job
from impact_damper.stages.design_orbit import design_orbit

job = Job(snakemake)
job.save(design_orbit(job.oscillator, job.damper, **job["search"], settling=job.settling))
