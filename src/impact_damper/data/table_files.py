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
