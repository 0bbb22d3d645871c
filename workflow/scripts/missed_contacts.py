"""Contacts near grazing that integrators miss, counted over random flights of the loose mass."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.methods.missed_contacts import missed_contacts

job = Job(snakemake)
job.save(
    missed_contacts(
        job.oscillator,
        job["frequency"],
        passages=job["passages"],
        radius=job["radius"],
        depths=job.powers("depths"),
        tolerances=job.powers("tolerances"),
        steps=job.counts("steps"),
        seed=job["seed"],
    )
)
