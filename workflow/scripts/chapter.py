"""Figures and tables of a chapter of the report, with their captions."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.workflow.chapter import draw_figure, make_table

job = Job(snakemake)
for key, given in job.given.items():
    kind, name = key.split("_", 1)
    if kind == "figure":
        draw_figure(given, job.datasets, job.results / "figures" / name)
    else:
        make_table(name, given, job.datasets, job.results / "tables" / name)
