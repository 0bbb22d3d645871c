"""Captions of all figures, from the templates that the report uses too."""

import sys
from pathlib import Path
from types import SimpleNamespace

import jinja2

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
for template, figure, output in zip(
    snakemake.input.templates, snakemake.params, snakemake.output, strict=True
):
    (job,) = figure.values()
    caption = jinja2.Template(Path(template).read_text(), undefined=jinja2.StrictUndefined)
    drawn = SimpleNamespace(params=SimpleNamespace(job=job))
    Path(output).write_text(caption.render(snakemake=drawn) + "\n")
