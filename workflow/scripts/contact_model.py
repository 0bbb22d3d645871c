"""Errors of the contact model over restitution and load, and contacts of simulated motions.

The load is the acceleration that all forces except the contact force cause.
"""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.contact_model import contact_model, spread_loads

job = Job(snakemake)
job.save(
    contact_model(
        job.oscillator,
        job.damper,
        job["frequencies"],
        job.grid("restitutions"),
        spread_loads(*job["loads"]),
        used=job["used"],
        starts=job["starts"],
        periods=job["periods"],
        seed=job["seed"],
        settling=job.settling,
    )
)
