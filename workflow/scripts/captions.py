"""Captions of all figures, from the templates that the report uses too."""

import sys
from pathlib import Path
from types import SimpleNamespace

import jinja2

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
for template, job, output in zip(
    snakemake.input.templates, snakemake.params.jobs, snakemake.output, strict=True
):
    caption = jinja2.Template(Path(template).read_text(), undefined=jinja2.StrictUndefined)
    figure = SimpleNamespace(params=SimpleNamespace(job=job))
    Path(output).write_text(caption.render(snakemake=figure) + "\n")
