"""Figures and tables of a chapter of the report, with their captions."""

from chatterjee1995.workflow.job import Job
from chatterjee1995.workflow.chapter import draw_figure, make_table

job = Job(snakemake)
for key, figure in job.given.items():
    if key.startswith("figure_"):
        path = job.results / "figures" / key.removeprefix("figure_")
        draw_figure(figure, job.datasets, path)
for name in job["tables"]:
    make_table(name, job.datasets, job.results / "tables" / name, job.given.get("drawn", ()))
