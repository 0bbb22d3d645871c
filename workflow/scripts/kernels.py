"""Compile the kernels and keep them, so that no other job has to; in two halves, side by side."""

from impact_damper.job import begin, end_with_parent

begin(snakemake)

import gc
from concurrent.futures import ProcessPoolExecutor

from impact_damper.warmup import warm_up_orbits, warm_up_settling

gc.disable()  # a compiler makes little garbage, and to look for it takes a fifth of its time
with ProcessPoolExecutor(snakemake.threads, initializer=end_with_parent) as pool:
    for half in [pool.submit(warm_up_orbits), pool.submit(warm_up_settling)]:
        half.result()
