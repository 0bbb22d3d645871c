"""Dampers of several masses, clearances and restitutions, for migration and for suppression.

Migration leaves the resonance by switching the damper on and off; suppression leaves it on.
"""

from impact_damper.workflow.job import Job
from impact_damper.stages.release_dampers import release_dampers

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
