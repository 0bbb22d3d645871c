"""Compile the methods to compare with and keep them, so that all jobs run the same code."""

import sys

from impact_damper.warmup import warm_up_rivals

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
warm_up_rivals()
