"""Runs of the controller that switches the damper to leave the resonance (figures 13 to 16)."""

from chatterjee1995.workflow.job import Job
from impact_damper.motions.migration import trials

job = Job(snakemake)
job.save(
    trials(
        job.oscillator,
        job.damper,
        job["frequency"],
        **job["controller"],
        seed=job["seed"],
        settling=job.settling,
        **job.running,
    )
)
