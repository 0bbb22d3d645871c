"""Compile the kernels and keep them, so that no other job has to."""

from impact_damper.job import begin
from impact_damper.warmup import warm_up

begin(snakemake.log[0])
warm_up()
