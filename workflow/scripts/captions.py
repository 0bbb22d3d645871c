"""Captions of all figures, from the templates that the report uses too."""

from impact_damper.workflow.job import begin

begin(snakemake)

from pathlib import Path
from types import SimpleNamespace

import jinja2

from impact_damper.data.whole_files import whole

for template, figure, output in zip(
    snakemake.input.templates, snakemake.params, snakemake.output, strict=True
):
    (job,) = figure.values()
    caption = jinja2.Template(Path(template).read_text(), undefined=jinja2.StrictUndefined)
    drawn = SimpleNamespace(params=SimpleNamespace(job=job))
    with whole(output) as part:
        part.write_text(caption.render(snakemake=drawn) + "\n")
