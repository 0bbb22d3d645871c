"""Figures and tables of a chapter of the report, in two formats each, with captions."""

from functools import partial
from importlib import import_module

from chatterjee1995.workflow.captions import caption
from chatterjee1995.workflow.registry import KINDS, TABLES
from impact_damper.data.whole_files import whole


def make_table(name, datasets, path, drawn=()) -> None:
    """Write a table as CSV and Markdown, with its caption.

    Parameters
    ----------
    name : str
        Name of a table in the registry.
    datasets : dict
        Datasets, keyed by stage and by entry of the configuration. May contain more stages than the
        table reads.
    path : pathlib.Path
        Name of the files, without suffix.
    drawn : sequence of str
        Names of the figures that the run draws, for a table that shows figures.
    """
    from impact_damper.data import table_files

    table = TABLES[name]
    module = import_module(table.module)
    read = {stage: datasets.get(stage, {}) for stage in table.stages}
    frame = getattr(module, name)(read)
    # A module has its own function `document` for Markdown, or it lists the columns in `SHOWN`.
    document = getattr(module, "document", None) or partial(
        table_files.for_people,
        title=table.caption.removesuffix("."),
        heads=module.SHOWN[name],
        csv_name=f"{name}.csv",
        cells=getattr(module, "CELLS", {}),
        rows=getattr(module, "ROWS", {}).get(name),
    )
    if table.pictures:
        document = partial(document, drawn=drawn)
    table_files.save_table(frame, f"{path}.csv", f"{path}.md", document)
    _write(f"{path}.rst", table.caption)


def draw_figure(figure, datasets, path) -> None:
    """Draw a figure as PDF and PNG, and write its caption.

    Parameters
    ----------
    figure : dict
        As `selection.figure_values` returns it.
    datasets : dict
        Datasets, keyed by stage and by entry of the configuration.
    path : pathlib.Path
        Name of the files, without suffix.
    """
    from impact_damper.plot.panels.style import save_figure

    kind = KINDS[figure["kind"]]
    module = import_module(kind.source)
    if kind.stages:
        draw = getattr(module, f"draw_{kind.name}")
        drawing = draw(
            **{
                stage: [datasets[stage][name] for name in names]
                for stage, names in figure["drawn"].items()
            }
        )
    else:
        (name,) = figure["data"]
        drawing = getattr(module, name)()
    save_figure(drawing, path)
    _write(f"{path}.rst", caption(figure, module.CAPTION))


def _write(path, text):
    """Write a text to a file, completely or not at all."""
    with whole(path) as part:
        part.write_text(text + "\n")
