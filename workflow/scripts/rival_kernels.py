"""Compile the methods to compare with and keep them, so that all jobs run the same code."""

from impact_damper.job import begin
from impact_damper.warmup import warm_up_rivals

begin(snakemake.log[0])
warm_up_rivals()
