"""Captions of figures, with the parameters in words; imports no NumPy."""

import re
from dataclasses import fields

from impact_damper.machine.machine import Machine
from impact_damper.machine.units import QUANTITIES
from impact_damper.system.parameters import SYMBOLS


def caption(figure, text) -> str:
    """Return the caption of a figure as one paragraph of reStructuredText.

    The forcing frequency has the symbol of the axes, Ω, in place of the W of texts.

    Parameters
    ----------
    figure : dict
        As `selection.figure_values` returns it.
    text : str
        `CAPTION` of the module that draws the kind of figure.
    """
    head = f"{figure['title']}: {figure['cases']}." if figure["cases"] else f"{figure['title']}."
    whole = "\n".join(part for part in (head, text.strip(), figure["remark"]) if part)
    return re.sub(r"\bW(?=p?\b)", "Ω", whole)


def in_words(values) -> str:
    """Return symbols and values of parameters, such as "h = 0.215, d0 = 2, W from 1 to 3".

    Parameters
    ----------
    values : dict
        Keyed by name of the parameter: a number, a list, a range with `first` and `last`, or "rule"
        for rule (19). Other keys are ignored.
    """
    words = [
        f"{symbol} {_value(values[name])}" for name, symbol in SYMBOLS.items() if name in values
    ]
    return ", ".join(words)


def machine_in_words(values) -> str:
    """Return the values of a machine with their units, such as "mass 12 kg, force 40 N".

    Parameters
    ----------
    values : dict
        Arguments of `Machine`; a value that is text has its unit already.
    """
    words = []
    for each in fields(Machine):
        if each.name in values:
            value, unit = values[each.name], QUANTITIES[each.metadata["quantity"]].unit
            text = value if isinstance(value, str) else f"{value:g} {unit}".rstrip()
            words.append(f"{each.name.replace('_', ' ')} {text}")
    return ", ".join(words)


def _value(value):
    if isinstance(value, dict):
        return f"from {value['first']} to {value['last']}"
    if isinstance(value, list):
        return f"= {', '.join(map(str, value))}"
    return "by (19)" if value == "rule" else f"= {value}"
