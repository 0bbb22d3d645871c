"""Captions of figures, with the parameters of the datasets drawn as text."""

import re
from dataclasses import fields

from impact_damper.model.machine import Machine
from impact_damper.model.parameters import SYMBOLS
from impact_damper.model.units import QUANTITIES

# If a list has more values than this, the text gives only the smallest and the largest.
MANY = 3


def caption(title, cases, text, remark) -> str:
    """Return the caption of a figure as one paragraph of reStructuredText.

    W and omega_l become Ω and ωl, the symbols on the axes. The bars of an absolute value are
    escaped, since reStructuredText takes text between bars for the name of a substitution.
    """
    head = f"{title}: {cases}." if cases else f"{title}."
    whole = "\n".join(part for part in (head, text.strip(), remark) if part)
    whole = re.sub(r"\bW(?=p?(²|\b))", "Ω", whole)
    return whole.replace("omega_l", "ωl").replace("|", r"\|")


def cases_in_words(entries, named=False) -> str:
    """Return the parameters of the entries that a figure draws, as text.

    `entries` holds values as text, keyed by entry and symbol. Parameters with the same value in all
    entries come first. Then each entry lists its own, with its name if `named`. If the entries
    differ in one parameter only, this parameter lists its values.
    """
    first, *others = entries.values()
    shared = [item for item in first.items() if all(item in each.items() for each in others)]
    parts = [_joined(shared)]
    own = {
        name: [item for item in each.items() if item not in shared]
        for name, each in entries.items()
    }
    (varied, *more) = dict.fromkeys(key for each in own.values() for key, _ in each) or [None]
    if named:
        parts += [f"{name.replace('_', ' ')}: {_joined(each)}" for name, each in own.items()]
    elif varied and not more and all(own.values()):
        values = [each[0][1].removeprefix("= ") for each in own.values()]
        parts.append(f"{varied} = {', '.join(values)}".replace("= by", "by"))
    else:
        parts += map(_joined, own.values())
    return "; ".join(part for part in parts if part)


def in_words(values) -> dict:
    """Return the values of parameters as text, keyed by symbol: "= 0.215", "from 1 to 3".

    A value is a number, a list, a range, or "rule" for the clearance by (19). Keys that are no
    parameters, and a linear stiffness of zero, are left out.
    """
    return {
        symbol: _value(values[name])
        for name, symbol in SYMBOLS.items()
        if name in values and (name, values[name]) != ("linear_frequency", 0)
    }


def machine_in_words(values) -> dict:
    """Return the arguments of `Machine` with their units, such as "12 kg", keyed by their names."""
    words = {}
    for each in fields(Machine):
        if each.name in values:
            value, unit = values[each.name], QUANTITIES[each.metadata["quantity"]].unit
            text = value if isinstance(value, str) else f"{_number(value)} {unit}".rstrip()
            words[each.name.replace("_", " ")] = text
    return words


def _joined(items):
    """Return pairs of name and value as text."""
    return ", ".join(f"{name} {value}" for name, value in items)


def _value(value):
    """Return the value of a parameter as text, such as "= 0.215" or "from 1 to 3"."""
    if hasattr(value, "first"):
        return f"from {_number(value.first)} to {_number(value.last)}"
    if isinstance(value, list) and len(value) > MANY:
        return f"from {_number(min(value))} to {_number(max(value))}"
    if isinstance(value, list):
        return f"= {', '.join(map(_number, value))}"
    return "by (19)" if value == "rule" else f"= {_number(value)}"


def _number(value):
    """Return a number as short text: 1e6 in place of 1e+06."""
    return f"{value:g}".replace("e+0", "e")
