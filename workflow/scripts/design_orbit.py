"""Exact quiet orbits of all curves at their peak frequencies, followed in damping.

The data are those of the paper's figure 3. A quiet orbit is the small periodic motion for which a
damper is designed.
"""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.design_orbit import design_orbit

job = Job(snakemake)
for entry in job.entries():
    entry.save(
        design_orbit(entry.oscillator, entry.damper, **entry["search"], settling=entry.settling)
    )
