"""Compile the kernels, the functions that numba compiles, and store them for all other jobs."""

from pathlib import Path

from chatterjee1995.workflow.job import Job
from chatterjee1995.workflow.compile_kernels import compile_all
from chatterjee1995.workflow.sources import compiled_kernels

job = Job(snakemake)
compile_all(snakemake.threads, snakemake.config["comparison"]["orders"])
Path(job.output).write_text(compiled_kernels(snakemake.config))
