"""Compile the kernels and store them, so that no other job has to; on two cores."""

import gc
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from impact_damper.workflow.compile_kernels import (
    warm_up_orbits,
    warm_up_rivals,
    warm_up_settling,
)
from impact_damper.workflow.job import Job, end_with_parent

job = Job(snakemake)
gc.disable()  # compiling makes little garbage, and its collection takes a fifth of the time
fork = get_context("fork")  # workers keep the setting
with ProcessPoolExecutor(snakemake.threads, fork, initializer=end_with_parent) as pool:
    for half in [pool.submit(warm_up_orbits), pool.submit(warm_up_settling)]:
        half.result()
    # These call kernels of both halves.
    pool.submit(warm_up_rivals, snakemake.params.orders).result()
