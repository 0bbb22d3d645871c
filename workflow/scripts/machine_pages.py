"""The pages of all machines, with their figures."""

from chatterjee1995.workflow.job import Job
from impact_damper.plot.pages.render import write_page

job = Job(snakemake)
for name, data in job.datasets["machines"].items():
    write_page(name, data, job.results / "machines" / name)
