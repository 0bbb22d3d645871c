"""The quiet motion by fixed-step methods, over contact stiffness and step."""

from impact_damper.workflow.job import Job
from impact_damper.stages.stable_steps import stable_steps

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
