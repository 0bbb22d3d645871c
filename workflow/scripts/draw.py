"""Every figure of data: the function `draw_<kind>`, in the module that draws the kind."""

from impact_damper.workflow.job import begin

begin(snakemake)

from importlib import import_module
from pathlib import Path

from impact_damper.data.datasets import load
from impact_damper.figures.style import save

draw = getattr(import_module(snakemake.params.module), f"draw_{snakemake.params.kind}")
drawing = draw(
    **{
        stage: [load(path) for path in paths]
        for stage, paths in snakemake.input.items()
        if stage != "code"
    }
)
save(drawing, Path(snakemake.output.pdf).with_suffix(""))
