"""Tables written as CSV and as Markdown."""

import numbers

import numpy as np

from impact_damper.data.whole_files import whole

# Significant digits of numbers.
DIGITS = 6


def save_table(frame, csv_path, markdown_path, document=None) -> None:
    """Write a table as CSV and as Markdown; each file appears only when it is complete.

    Numbers are rounded to six significant digits; NaN and None become empty cells.

    Parameters
    ----------
    frame : pandas.DataFrame
    csv_path, markdown_path : str or pathlib.Path
    document : callable, optional
        Function from the rounded table to its Markdown text; `as_markdown` by default.
    """
    shown = frame.map(_rounded).astype(object)
    _write(csv_path, shown.to_csv(index=False, lineterminator="\n"))
    _write(markdown_path, (document or as_markdown)(shown) + "\n")


def as_markdown(frame) -> str:
    """Return the Markdown text of a table of strings."""

    def escaped(value):
        return str(value).replace("|", r"\|")

    text = frame.map(escaped).rename(columns=escaped)
    return text.to_markdown(index=False, disable_numparse=True)


def for_people(frame, title, heads, csv_name) -> str:
    """Return the Markdown text of the columns of a table that people read first.

    Parameters
    ----------
    frame : pandas.DataFrame
        Table of strings.
    title : str
    heads : dict of str
        Keyed by the names of the columns shown: their heads, in words, with symbol and unit. A
        column that the frame does not have, since its data were not computed, is left out.
    csv_name : str
        Name of the file with all columns.
    """
    shown = frame[[name for name in heads if name in frame]].rename(columns=heads)
    note = (
        "Numbers without a unit are dimensionless; an empty cell is a quantity that does not "
        f"exist there or was not computed. `{csv_name}` has all {frame.shape[1]} columns."
    )
    body = "The configuration has no data for this table." if frame.empty else as_markdown(shown)
    return "\n\n".join([f"# {title}", note, body])


def _write(path, content):
    with whole(path) as part:
        part.write_text(content)


def _rounded(value):
    """Return the text of a table cell for its value."""
    if isinstance(value, str):
        return value
    if isinstance(value, numbers.Integral):
        return str(value)
    return "" if value is None or np.isnan(value) else f"{value:.{DIGITS}g}"
