"""The page of a design in HTML with its figures, and its conclusion in sentences."""

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
from impact_damper.plot import style
from impact_damper.plot.machine_figures import ENDLESS, FIGURES
from impact_damper.plot.pages.numbers import numbers_of, size

# Dots per inch: 1540 pixels for a figure of 7 inches, so that pages never enlarge it.
DPI = 220
# Start of the line of HTML by which a page of this package is recognised.
GENERATOR = '<meta name="generator" content="impact-damper'


def conclusion(data) -> list[str]:
    """Return the conclusion of a result of `design_damper` in paragraphs."""
    return _conclusion(numbers_of(data))


def write_page(name, data, folder, file=None, date="", figures=FIGURES) -> None:
    """Write `index.html`, the page of the machine `name`, into a folder.

    `file` is the name of the file of `data`, by default `name`.nc. `figures` maps names to
    functions that return a figure of `data` or None.
    """
    drawn = {each: draw(data) for each, draw in figures.items()}
    pictures = {each: as_png(figure) for each, figure in drawn.items() if figure is not None}
    with whole(Path(folder) / "index.html") as part:
        part.write_bytes(page_of(name, data, pictures, file, date).encode())


def page_of(name, data, pictures, file=None, date="") -> str:
    """Return the page in HTML. `pictures` maps names of figures to PNG data."""
    numbers = numbers_of(data)
    numbers |= {
        "title": f"Impact damper for the machine {name.replace('_', ' ')}",
        "conclusion": _conclusion(numbers),
        "file": file or f"{name}.nc",
        "input": data.attrs.get("input_file", f"the entry {name} of the configuration"),
        "version": version("impact-damper"),
        "date": date,
        "generator": Markup(GENERATOR),
        "pictures": {each: base64.b64encode(png).decode() for each, png in pictures.items()},
        "sources": [],
    }
    return _environment(True).get_template("design.jinja").render(numbers).lstrip()


def as_png(figure) -> bytes:
    """Return a figure as PNG, reproducible to the byte."""
    with style.context(), io.BytesIO() as file:
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
    """Return a text in one line. Escaped text stays escaped."""
    joined = " ".join(str(text).split())
    return Markup(joined) if isinstance(text, Markup) else joined
