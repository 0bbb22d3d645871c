"""Compile the kernels and keep them, so that no other job has to."""

from impact_damper.job import begin

begin(snakemake)

from impact_damper.warmup import warm_up

warm_up()
