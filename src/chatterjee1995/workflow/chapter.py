"""Save figures and tables of a chapter of the report, each in two formats and with a caption."""

from functools import partial
from importlib import import_module

from chatterjee1995.workflow.job import imported
from impact_damper.data.whole_files import whole


def make_table(name, given, datasets, path) -> None:
    """Save a table as CSV and Markdown, with its caption. `given` is from `table_values`."""
    from chatterjee1995.tables import files as table_files

    module = import_module(given["module"])
    frame = getattr(module, name)({stage: datasets.get(stage, {}) for stage in given["stages"]})
    if "drawn" in given:
        document = partial(module.document, drawn=given["drawn"])
    else:
        title = given["caption"].removesuffix(".")
        document = partial(table_files.for_people, title=title, csv_name=f"{name}.csv")
    table_files.save_table(frame, f"{path}.csv", f"{path}.md", document)
    _write(f"{path}.rst", given["caption"])


def draw_figure(given, datasets, path) -> None:
    """Save a figure as PDF and PNG, with its caption. `given` is from `figure_values`."""
    from impact_damper.plot.style import save_figure

    drawn = given["drawn"].items()
    draw = imported(given["function"])
    save_figure(draw(**{k: [datasets[k][name] for name in names] for k, names in drawn}), path)
    _write(f"{path}.rst", given["caption"])


def _write(path, text):
    with whole(path) as part:
        part.write_text(text + "\n")
