"""Captions of figures, with the parameters in words; imports no NumPy."""

from impact_damper.system.parameters import SYMBOLS


def caption(figure, text) -> str:
    """Return the caption of a figure as one paragraph of reStructuredText.

    Parameters
    ----------
    figure : dict
        As `selection.figure_values` returns it.
    text : str
        `CAPTION` of the module that draws the kind of figure.
    """
    head = f"{figure['title']}: {figure['cases']}." if figure["cases"] else f"{figure['title']}."
    return "\n".join(part for part in (head, text.strip(), figure["remark"]) if part)


def in_words(values) -> str:
    """Return symbols and values of parameters, such as "h = 0.215, d0 = 2, W from 1 to 3".

    Parameters
    ----------
    values : dict
        By name of the parameter: a number, a list, a range with `first` and `last`, or "rule" for
        rule (19). Other keys are ignored.
    """
    words = [
        f"{symbol} {_value(values[name])}" for name, symbol in SYMBOLS.items() if name in values
    ]
    return ", ".join(words)


def _value(value):
    if isinstance(value, dict):
        return f"from {value['first']} to {value['last']}"
    if isinstance(value, list):
        return f"= {', '.join(map(str, value))}"
    return "by (19)" if value == "rule" else f"= {value}"
