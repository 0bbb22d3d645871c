"""Largest displacement against clearance, and its optimum (paper: figures 6, 7 and 11)."""

from chatterjee1995.workflow.job import Job
from impact_damper.orbits.clearance_sweep import clearance_sweep

job = Job(snakemake)
job.save(
    clearance_sweep(
        job.oscillator,
        job["damper"],
        job["frequency"],
        job.grid("clearances"),
        **job["search"],
        settling=job.settling,
        **job.running,
    )
)
