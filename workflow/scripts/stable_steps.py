"""The quiet motion by fixed-step methods, over contact stiffness and step."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.methods.stable_steps import stable_steps

job = Job(snakemake)
job.save(
    stable_steps(
        job.oscillator,
        job.damper,
        job["frequency"],
        stiffnesses=job.powers("stiffnesses"),
        scaled_steps=job.powers("scaled_steps"),
        most_steps=job["most_steps"],
        periods=job["periods"],
    )
)
