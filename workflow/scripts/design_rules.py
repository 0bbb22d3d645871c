"""Rules for the clearance, compared with the clearance of the smallest quiet motion."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.design_rules import design_rules

job = Job(snakemake)
job.save(design_rules(job.oscillator, *job["grid"], progress=job["name"]))
