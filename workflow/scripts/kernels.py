"""Compile the kernels and keep them, so that no other job has to; in two halves, side by side."""

from impact_damper.workflow.job import begin, end_with_parent

begin(snakemake)

import gc
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context

from impact_damper.workflow.compile_kernels import warm_up_orbits, warm_up_settling

gc.disable()  # compiling makes little garbage, and its collection takes a fifth of the time
fork = get_context("fork")  # workers keep the setting
with ProcessPoolExecutor(snakemake.threads, fork, initializer=end_with_parent) as pool:
    for half in [pool.submit(warm_up_orbits), pool.submit(warm_up_settling)]:
        half.result()
