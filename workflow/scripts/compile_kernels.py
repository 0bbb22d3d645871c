"""Compile the kernels (numba functions) and store them for all other jobs."""

from pathlib import Path

from chatterjee1995.workflow.job import Job
from chatterjee1995.workflow.kernels import compile_all, compiled_kernels

Job(snakemake)
orders = snakemake.config["comparison"]["orders"]
compile_all(snakemake.threads, orders)
Path(snakemake.output[0]).write_text(compiled_kernels(orders))
