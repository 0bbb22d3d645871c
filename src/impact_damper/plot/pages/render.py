"""The page of a design in HTML and Markdown with its figures, and its conclusion in sentences."""

import base64
import io
import re
from importlib.metadata import version
from pathlib import Path

import numpy as np
from jinja2 import Environment, PackageLoader, StrictUndefined
from markupsafe import Markup

from impact_damper.data.whole_files import whole
from impact_damper.model.text import number, percent
from impact_damper.plot.machine_figures.figures import ENDLESS, FIGURES
from impact_damper.plot.pages.numbers import numbers_of, size
from impact_damper.plot.style import style

# Dots per inch: 1540 pixels for a figure of 7 inches, so that pages never enlarge it.
DPI = 220
# Files of a page, with the templates that lay them out.
LAYOUTS = {"index.html": "html.jinja", "report.md": "markdown.jinja"}
# Begin of the line by which a page of this package is recognised.
GENERATOR = '<meta name="generator" content="impact-damper'


def conclusion(data) -> list[str]:
    """Return the answer of a design in paragraphs, for a result of `design_damper`."""
    return _conclusion(numbers_of(data))


def write_page(name, data, folder, file=None, date="", figures=FIGURES) -> None:
    """Write the page of the machine `name` and its figures into a folder.

    Parameters
    ----------
    name : str
    data : xarray.Dataset
        Result of `design_damper` or `evaluate_damper`.
    folder : str or pathlib.Path
    file : str, optional
        Name of the file of `data`, by default that of the pipeline.
    date : str
        Date of the design.
    figures : dict of callable
        Functions that return a figure of `data` or None, keyed by name.
    """
    folder = Path(folder)
    drawn = {each: draw(data) for each, draw in figures.items()}
    pictures = {each: as_png(figure) for each, figure in drawn.items() if figure is not None}
    files = {f"{each}.png": picture for each, picture in pictures.items()}
    encoded = {each: base64.b64encode(picture).decode() for each, picture in pictures.items()}
    for place, text in pages(name, data, encoded, file, date).items():
        files[place] = text.encode()
    for place, content in files.items():
        with whole(folder / place) as part:
            part.write_bytes(content)


def pages(name, data, pictures, file=None, date="") -> dict[str, str]:
    """Return the page in each form, keyed by the name of its file.

    `pictures` are the figures as PNG, encoded in base64, keyed by name.
    """
    numbers = numbers_of(data)
    numbers |= {
        "title": f"Impact damper for the machine {name.replace('_', ' ')}",
        "conclusion": _conclusion(numbers),
        "file": file or f"{name}.nc",
        "input": data.attrs.get("input_file", f"the entry {name} of the configuration"),
        "version": version("impact-damper"),
        "date": date,
        "generator": Markup(GENERATOR),
        "pictures": pictures,
    }
    found = {}
    for place, layout in LAYOUTS.items():
        template = _environment(layout == "html.jinja").get_template("design.jinja")
        text = template.render(numbers | {"layout": layout, "sources": []})
        found[place] = re.sub(r"\n{3,}", "\n\n", text).lstrip()
    return found


def as_png(figure) -> bytes:
    """Return a figure as PNG, reproducible to the byte."""
    with style(), io.BytesIO() as file:
        figure.savefig(file, format="png", dpi=DPI, metadata={"Software": None})
        return file.getvalue()


def _conclusion(numbers):
    """Return the paragraphs of the conclusion."""
    text = _environment(False).get_template("conclusion.jinja").render(numbers)
    parts = [_one_line(part) for part in re.split(r"\n\s*\n", text) if part.strip()]
    return [re.sub(r" ([,.:;])", r"\1", part) for part in parts]


def _environment(escaping):
    """Return the environment of the templates, with filters for numbers."""
    environment = Environment(
        loader=PackageLoader("impact_damper.plot.pages"),
        autoescape=escaping,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters |= {"number": number, "percent": percent, "size": size}
    environment.filters["one_line"] = _one_line
    environment.tests["finite"] = lambda value: np.isfinite(value) and value < ENDLESS
    return environment


def _one_line(text):
    """Return a text in one line; escaped text stays escaped."""
    joined = " ".join(str(text).split())
    return Markup(joined) if isinstance(text, Markup) else joined
