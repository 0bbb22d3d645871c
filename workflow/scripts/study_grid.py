"""The chunks of a study as one file."""

import sys

from impact_damper.gathering import gather_chunks

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
gather_chunks(snakemake.input.chunks, snakemake.output[0])
