"""Lines that report a problem of the configuration: the key, its value, and what it must be."""

import re
import reprlib

from impact_damper.model.bounds import nearest

# Numbers with an exponent. YAML 1.1 reads them as text if the point is missing or the exponent has
# no sign.
SCIENTIFIC = re.compile(r"[-+]?(\d+\.?\d*|\.\d+)[eE][-+]?\d+")


def problem(path, value, reason) -> str:
    """Return the line on a wrong value: its path of keys, the value, and what it must be."""
    if isinstance(value, str) and SCIENTIFIC.fullmatch(value):
        reason += f"; YAML takes this for text, and {_point(value)} for a number"
    return f"{dotted(path)} = {reprlib.repr(value)}: {reason}"


def _point(text):
    """Return a number in scientific notation with the point and the sign that YAML 1.1 requires."""
    mantissa, exponent = text.lower().split("e")
    mantissa += "" if "." in mantissa else ".0"
    return f"{mantissa}e{exponent if exponent[0] in '+-' else f'+{exponent}'}"


def missing(path, reason) -> str:
    """Return the line on a key that is missing."""
    return f"{dotted(path)}: missing; {reason}"


def dotted(path) -> str:
    """Return a path of keys and list positions as one key with dots."""
    return ".".join(map(_word, path)) or "configuration"


def one_of(name, known) -> str:
    """Return the text "must be one of ..." with all known names, and the name nearest to `name`."""
    return f"must be one of {', '.join(known)}{nearest(name, known)}"


def _word(key):
    """Return a key unchanged, or quoted if it contains a line break or is long."""
    plain = isinstance(key, str) and key.isprintable() and len(key) <= 80
    return key if plain else reprlib.repr(key)
