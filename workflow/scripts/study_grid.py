"""The chunks of a study as one file."""

from impact_damper.workflow.job import begin

begin(snakemake)

from impact_damper.stages.study_grid import gather_chunks

gather_chunks(snakemake.input.chunks, snakemake.output[0])
