"""Functions that write tables to files, and a function that makes columns of parameters."""

import numbers
import re
from functools import partial

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.data.whole_files import whole
from impact_damper.model.text import number

DIGITS, FEW_DIGITS = 6, 4  # significant digits in CSV files, significant digits in Markdown files
SHOWN = 9  # number of columns that the page of a table shows
HEADS = {
    "damping": "damping h",
    "linear_frequency": "linear frequency ωl",
    "frequency": "forcing frequency Ω",
    "mass_ratio": "mass ratio rm",
    "clearance": "clearance d0",
    "restitution": "restitution e",
    "contact_stiffness": "contact stiffness r1",
}
DAMPER = ("mass_ratio", "clearance", "restitution")


def as_markdown(frame) -> str:
    """Return a table of strings as Markdown text."""

    def escaped(value):
        return str(value).replace("|", r"\|")

    text = frame.map(escaped).rename(columns=escaped)
    return text.to_markdown(index=False, disable_numparse=True)


def save_table(frame, csv_path, markdown_path, document=as_markdown) -> None:
    """Write a table to a CSV file, and to a Markdown file whose text `document(table)` returns."""
    values = frame.map(_rounded).astype(object)
    _write(csv_path, values.to_csv(index=False, lineterminator="\n"))
    shown = frame.map(partial(_rounded, digits=FEW_DIGITS)).astype(object)
    _write(markdown_path, document(shown) + "\n")


def for_people(frame, title, csv_name) -> str:
    """Return a Markdown page with the first columns of a table and the name of its CSV file."""
    note = (
        "Numbers without a unit are dimensionless; an empty cell is a quantity that does not "
        f"exist there or was not computed. `{csv_name}` has all {frame.shape[1]} columns."
    )
    body = "The configuration has no data for this table."
    if not frame.empty:
        body = as_markdown(frame.iloc[:, :SHOWN].map(in_words))
    return "\n\n".join([f"# {title}", note, body])


def in_words(cell) -> str:
    """Return a name in words: "figure 3 (c), rule" for "figure_03c_rule"."""
    cell = re.sub(r"^orbits_(?=[0-9])", "orbits of figure_", str(cell))
    cell = re.sub(r"\bfigure_0*([0-9]+)([a-z])", r"figure_\1 (\2)", cell)
    cell = re.sub(r"\bfigure_0*([0-9]+)", r"figure \1", cell).replace(")_", "), ")
    return "∞" if cell == "inf" else re.sub(r"(?<=\w)_(?=\w)", " ", cell)


def _write(path, content):
    with whole(path) as part:
        part.write_text(content)


def _rounded(value, digits=DIGITS):
    if isinstance(value, str | numbers.Integral) or np.isinf(value or 0):
        return str(value)
    return "" if value is None or np.isnan(value) else number(value, digits)


def parameter_columns(data, *names) -> dict:
    """Return a dict: head of a column -> value of a parameter. Names not in `data` are left out."""
    parameters = parameters_of(data)
    return {HEADS[name]: parameters[name] for name in names if name in parameters}
