"""Shares of random initial states that lead to collisions (section 3 of the paper, claim 8)."""

from chatterjee1995.workflow.job import Job
from impact_damper.motions.response import collisions

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
