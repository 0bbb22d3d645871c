"""A steady motion over its period (paper: figure 4)."""

from chatterjee1995.workflow.job import Job
from impact_damper.motions.steady import steady_orbit

job = Job(snakemake)
# The three numbers under figure 4 of the paper, and relative velocity 0. A start at rest would lead
# to a motion without contact.
start = (1.0, 0.5, 0.0, 0.0)
job.save(
    steady_orbit(
        job.oscillator,
        job.damper,
        job["frequency"],
        start,
        samples=4000,
        settling=job.settling,
    )
)
