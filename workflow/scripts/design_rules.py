"""Rules for the clearance, compared with the clearance of the smallest quiet motion."""

from impact_damper.workflow.job import Job
from impact_damper.stages.design_rules import design_rules

job = Job(snakemake)
job.save(design_rules(job.oscillator, *job["grid"], progress=job["name"]))
