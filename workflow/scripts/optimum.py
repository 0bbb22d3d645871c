"""Largest displacement against clearance, and its optimum (paper: figures 6, 7 and 11)."""

from impact_damper.workflow.job import Job
from impact_damper.stages.optimum import clearance_sweep

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
