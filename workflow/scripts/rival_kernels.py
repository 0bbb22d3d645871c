"""Compile the methods to compare with and keep them, so that all jobs run the same code."""

from impact_damper.workflow.job import begin

begin(snakemake)

import gc

from impact_damper.workflow.compile_kernels import warm_up_rivals

gc.disable()  # as for the kernels
warm_up_rivals(snakemake.params.orders)
