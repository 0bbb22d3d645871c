"""Dampers compared for migration control and for suppression, by mass, clearance and
restitution."""

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
