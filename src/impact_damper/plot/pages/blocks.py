"""Parts of a page, laid out by the templates in `templates/`, and numbers as text.

The field `kind` of a part tells the template how to lay it out.
"""

from typing import NamedTuple

import numpy as np

# Superscripts for the digits and the minus of an exponent.
RAISED = str.maketrans("0123456789-", "⁰¹²³⁴⁵⁶⁷⁸⁹⁻")


class Words(NamedTuple):
    """A paragraph."""

    text: str
    kind: str = "words"


class Points(NamedTuple):
    """A list of sentences."""

    texts: list
    kind: str = "points"


class Numbers(NamedTuple):
    """Rows of three texts: description of a number, its value with unit, and its source."""

    rows: list
    kind: str = "numbers"


class Table(NamedTuple):
    """A table of texts, and the sources of its numbers."""

    columns: list
    rows: list
    source: str
    kind: str = "table"


class Picture(NamedTuple):
    """A figure: its name, from which the name of its file follows, and its caption."""

    name: str
    caption: str
    kind: str = "picture"


class Section(NamedTuple):
    """A heading with the parts below it."""

    title: str
    blocks: list


class Page(NamedTuple):
    """A page: title, advice in a few words, sentences that give its reasons, and sections."""

    title: str
    advice: str
    reasons: list
    sections: list


def shown(value, unit="", digits=3) -> str:
    """Return a number with its unit; "escapes" for infinity, "none found" for NaN.

    Displacements are infinite for motions that escape, and NaN if no motion was found.
    """
    value = float(value)
    if np.isnan(value):
        return "none found"
    if np.isinf(value):
        return "escapes"
    if abs(value) >= 1e5 or 0 < abs(value) < 1e-3:
        number, power = f"{value:.{digits - 1}e}".split("e")
        if "." in number:
            number = number.rstrip("0").rstrip(".")
        text = f"{number} × 10{str(int(power)).translate(RAISED)}"
    else:
        text = np.format_float_positional(value, digits, unique=False, fractional=False, trim="-")
    return f"{text} {unit}".rstrip()


def percent(share, digits=3) -> str:
    """Return a share in per cent."""
    return shown(100 * float(share), "%", digits)


def share_with_interval(values) -> str:
    """Return a share with its 95 % interval, as text, from three numbers: share, lower, upper."""
    share, low, high = (percent(value) for value in values)
    return f"{share} ({low} to {high})"
