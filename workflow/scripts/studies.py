"""A study over mass ratio, clearance, frequency and restitution, joined from its chunks."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.stages.studies import gather_chunks

job = Job(snakemake)
gather_chunks(list(snakemake.input.chunks), snakemake.output[0])
