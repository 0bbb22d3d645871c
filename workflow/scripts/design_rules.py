"""Rules for the clearance against the optimum of the quiet motion, on a grid of dampers."""

from impact_damper.workflow.job import Job
from impact_damper.stages.design_rules import design_rules

job = Job(snakemake)
job.save(design_rules(job.oscillator, *job["grid"], progress=job["name"]))
