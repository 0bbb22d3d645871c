"""Registry of the variables in all datasets: name, dimensions, unit, symbol, named values."""

import re
from typing import NamedTuple

# A bar between spaces separates columns of a table. The bars in "max |Z1|" do not.
BAR = re.compile(r"(?<!\S)\|(?!\S)")


class Variable(NamedTuple):
    """One variable of the datasets; `long_name` is also the text of an axis label.

    `kind` gives the unit in datasets of machines: a key of `model.units.QUANTITIES`, "state" for
    displacements and velocities, "followed" for the parameter that varies, or "mixed" for a number
    that combines several kinds, such as the distance between two states.
    """

    dims: tuple
    long_name: str
    symbol: str = ""
    kind: str = "number"
    flags: dict | None = None

    @property
    def units(self) -> str:
        """Unit in datasets of an `Oscillator`: "1", or "radian" for an angle."""
        return "radian" if self.kind == "angle" else "1"


VARIABLES: dict[str, Variable] = {}


def register(table) -> None:
    """Add variables to the registry; a name that is registered already is an error.

    The table has a line "name | dimensions | kind | symbol | description" for each variable. An
    empty kind means a plain number. An indented line continues the description, or names values:
    "  : absent 0, found 1", or "  : outcome" for the values of `outcome`. "#" begins a comment.
    """
    entries = []
    for line in table.splitlines():
        text = line.strip()
        if not text or text.startswith("#"):
            continue
        if not line.startswith("  "):
            entries.append([text, ""])
        elif text.startswith(":"):
            entries[-1][1] += text[1:]
        else:
            entries[-1][0] += f" {text}"
    for entry, values in entries:
        name, dims, kind, symbol, words = map(str.strip, BAR.split(entry, 4))
        if name in VARIABLES:
            raise ValueError(f"{name}: registered twice")
        flags = _named_values(values)
        VARIABLES[name] = Variable(tuple(dims.split()), words, symbol, kind or "number", flags)


def _named_values(text):
    text = text.strip()
    if not text or text in VARIABLES:
        return VARIABLES[text].flags if text else None
    pairs = (each.split() for each in text.rstrip(",").split(","))
    return {name: int(value) for name, value in pairs}


# The variable `basin_label` holds the number of the orbit to which a state of the primary mass
# leads, or one of these values. `mixed`: the place of the loose mass decides between orbits.
BASIN_LABEL = {
    "unresolved": -1,
    "escaped": -2,
    "chaotic": -3,
    "no_contact": -4,
    "mixed": -5,
    "quasi_periodic": -6,
}
