"""Numbers as text for people: rounded, with units, and "none" for a missing number."""

import math

# Rounded numbers from 1 to below 10**POSITIONAL are written without an exponent.
POSITIONAL = 5


def number(value, digits=3) -> str:
    """Return a number as text with `digits` significant digits, such as "2e7"; NaN is "none"."""
    value = float(value) + 0.0  # -0.0 becomes 0.0
    if not math.isfinite(value):
        return "none" if math.isnan(value) else "∞" if value > 0 else "-∞"
    text = f"{value:.{digits}g}"
    if "e" not in text:
        return text
    mantissa, power = text.split("e")
    if 0 < int(power) < POSITIONAL:
        return f"{float(text):.0f}"
    return f"{mantissa}e{int(power)}"


def percent(share, digits=3) -> str:
    """Return a share as text in per cent. A share below 1 is never rounded up to "100 %"."""
    if 0.9 < share < 1:  # rounding must not give 100 %
        digits = max(digits, 1 - math.floor(math.log10(1 - share)))
    text = number(100 * share, digits)
    return text if text == "none" else f"{text} %"


def with_unit(value, unit, digits=6) -> str:
    """Return a number and its unit as text. The unit "1" is left out, and NaN becomes "none"."""
    text = number(value, digits)
    return text if text == "none" or unit in ("", "1") else f"{text} {unit}"


def plain(value) -> str:
    """Return a number as text with six digits if these are exact, otherwise with all digits."""
    value = float(value)
    if not math.isfinite(value):
        return repr(value)
    short = number(value, 6)
    return short if float(short) == value else repr(value)
