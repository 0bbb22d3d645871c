"""Dampers of several masses, clearances and restitutions, for migration and for suppression.

Migration leaves the resonance by switching the damper on and off; suppression leaves it on.
"""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.release_dampers import release_dampers

job = Job(snakemake)
job.save(
    release_dampers(
        job.oscillator,
        **job["dampers"],
        **job["numbers"],
        settling=job.settling,
        **job.running,
    )
)
