"""Shares of random initial states that lead to collisions (section 3 of the paper, claim 8)."""

from impact_damper.workflow.job import Job
from impact_damper.stages.response import collisions

job = Job(snakemake)
for entry in job.entries():
    entry.save(
        collisions(
            entry.oscillator,
            entry.damper,
            entry["frequency"],
            radius=entry["radius"],
            seed=entry["seed"],
        )
    )
