"""Compile the kernels, the functions that numba compiles, and store them for all other jobs."""

from pathlib import Path

from impact_damper.workflow.job import Job
from impact_damper.workflow.compile_kernels import compile_all
from impact_damper.workflow.sources import compiled_kernels

job = Job(snakemake)
compile_all(snakemake.threads, snakemake.config["comparison"]["orders"])
Path(job.output).write_text(compiled_kernels(snakemake.config))
