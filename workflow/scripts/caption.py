"""Caption of a figure, from the template that the report uses too."""

import sys
from pathlib import Path

import jinja2

sys.stdout = sys.stderr = open(snakemake.log[0], "w", buffering=1)
template = jinja2.Template(
    Path(snakemake.input.template).read_text(), undefined=jinja2.StrictUndefined
)
Path(snakemake.output[0]).write_text(template.render(snakemake=snakemake) + "\n")
