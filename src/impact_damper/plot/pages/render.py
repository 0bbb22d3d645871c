"""Files of a page: HTML that needs no other file, Markdown, and the figures as PNG."""

import base64
import io
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined

from impact_damper.data.whole_files import whole
from impact_damper.plot.style import style

# Dots per inch: 748 pixels for a figure of 3.4 inches, so that pages never enlarge it.
DPI = 220


def write_page(page, figures, data, folder) -> None:
    """Write `index.html`, `report.md` and the figures into a folder.

    Parameters
    ----------
    page : blocks.Page
    figures : dict of callable
        Functions that return a figure of `data`, keyed by name.
    data : xarray.Dataset
    folder : str or pathlib.Path
    """
    pictures = {name: as_png(draw(data)) for name, draw in figures.items()}
    for name, picture in pictures.items():
        _write(Path(folder) / f"{name}.png", picture)
    encoded = {name: base64.b64encode(each).decode() for name, each in pictures.items()}
    _write(Path(folder) / "index.html", as_text("page.html", page, encoded).encode())
    _write(Path(folder) / "report.md", as_text("page.md", page, encoded).encode())


def as_png(figure) -> bytes:
    """Return a figure as PNG, reproducible to the byte."""
    with style(), io.BytesIO() as file:
        figure.savefig(file, format="png", dpi=DPI, metadata={"Software": None})
        return file.getvalue()


def as_text(template, page, pictures) -> str:
    """Return a page as text, laid out by a template.

    Parameters
    ----------
    template : str
        "page.html" or "page.md".
    page : blocks.Page
    pictures : dict of str
        Figures as PNG, encoded in base64, keyed by name.
    """
    environment = Environment(
        loader=PackageLoader("impact_damper.plot.pages"),
        autoescape=template.endswith(".html"),
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        keep_trailing_newline=True,
    )
    environment.filters["one_line"] = lambda text: " ".join(text.split())
    return environment.get_template(template).render(page=page, pictures=pictures)


def _write(path, content):
    """Write bytes to a file, completely or not at all."""
    with whole(path) as part:
        part.write_bytes(content)
