"""All branches of periodic orbits of a curve, stable or not (paper: figures 2, 5, 8 and 10)."""

from chatterjee1995.workflow.job import Job
from impact_damper.data.datasets import load
from impact_damper.orbits.all_branches import complete_branches

job = Job(snakemake)
motions = [load(path) for path in snakemake.input.motions]
job.save(
    complete_branches(job.oscillator, job.damper, job["frequencies"], motions, progress=job["name"])
)
