"""Rigid impacts compared with compliant contact, over frequency and contact stiffness."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.rigid_limit import rigid_limit

job = Job(snakemake)
for entry in job.entries():
    entry.save(
        rigid_limit(
            entry.oscillator,
            entry.damper,
            entry["frequency"],
            entry.grid("frequencies"),
            entry.powers("stiffnesses"),
            starts=entry["starts"],
            seed=entry["seed"],
            settling=entry.settling,
        )
    )
