"""The page of a machine, in HTML and Markdown, with its figures."""

from pathlib import Path

from impact_damper.workflow.job import Job
from impact_damper.pages.machine import FIGURES, machine_page
from impact_damper.pages.render import write_page

job = Job(snakemake)
((name, data),) = job.datasets["machines"].items()
write_page(machine_page(name, data), FIGURES, data, Path(job.output).parent)
