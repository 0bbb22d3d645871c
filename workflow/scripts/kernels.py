"""Compile the kernels and keep them, so that no other job has to."""

import sys

from impact_damper.warmup import warm_up

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
warm_up()
