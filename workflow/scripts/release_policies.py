"""Policies of migration control compared: rules that say when to switch the damper off."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.release_policies import release_policies
from impact_damper.model.parameters import Damper

job = Job(snakemake)
job.save(
    release_policies(
        job.oscillator,
        [Damper(**given) for given in job["dampers"]],
        **job["policies"],
        settling=job.settling,
        **job.running,
    )
)
