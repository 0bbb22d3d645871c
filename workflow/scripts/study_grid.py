"""The chunks of a study as one file."""

from impact_damper.gathering import gather_chunks
from impact_damper.job import begin

begin(snakemake.log[0])
gather_chunks(snakemake.input.chunks, snakemake.output[0])
