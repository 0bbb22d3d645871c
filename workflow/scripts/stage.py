"""The datasets of a stage, computed by its function."""

from chatterjee1995.workflow.job import Job

Job(snakemake).run()
