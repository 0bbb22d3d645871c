"""Numbers as words of a sentence; NaN is an unknown number."""

import math

# Up to this total a part of several things is given as a number, beyond as a percentage.
FEW = 20


def number(value, digits=3, bound="") -> str:
    """Return a number with a few significant digits, rounded up or down if it is a bound.

    Parameters
    ----------
    value : float
    digits : int
    bound : {"", "up", "down"}
        "up" for a number after "at most", "down" after "at least", so that the sentence holds.
    """
    if math.isnan(value):
        return "an unknown number"
    decimals = digits - 1 - math.floor(math.log10(abs(value))) if value else 0
    return f"{_rounded(value, decimals, bound):.{digits}g}"


def percent(share, bound="") -> str:
    """Return a share as a percentage of two or three digits, rounded as in `number`.

    Only a share of exactly 0 or 1 is printed as 0 % or 100 %.
    """
    if math.isnan(share):
        return "an unknown share"
    if 0 < share < 0.0005:
        return "less than 0.1 %"
    if share == 1 or not 0.95 < share < 1:
        decimals = 0 if abs(share) >= 0.1 else 1
        rounded = _rounded(100 * share, decimals, bound)
        return f"{rounded:.{decimals}f}".removesuffix(".0") + " %"
    digits, decimals = (3, 1) if share < 0.999 else (4, 2)
    text = f"{_rounded(100 * share, decimals, bound):.{digits}g}"
    return "more than 99.99 %" if text == "100" else f"{text} %"


def _rounded(value, decimals, bound):
    """Return a number rounded up or down to a number of decimals; unchanged if `bound` is "".

    A number that differs from a rounded one only by rounding errors is set to this one.
    """
    if not bound:
        return value
    scaled = value * 10.0**decimals
    near = round(scaled)
    if not math.isclose(scaled, near, rel_tol=1e-9, abs_tol=1e-9):
        near = math.ceil(scaled) if bound == "up" else math.floor(scaled)
    return near / 10.0**decimals


def part_of(share, things, count=None) -> str:
    """Return a share in words, such as "81 % of the runs", "all runs", "none of the 400 runs"."""
    total = things if count is None else f"{count} {things}"
    if share == 1:
        return f"all {total}"
    if share == 0:
        return f"none of the {total}"
    if count is None or count > FEW or math.isnan(share):
        return f"{percent(share)} of the {total}"
    return f"{round(share * count)} of the {total}"


def least(share) -> str:
    """Return a lower bound of a share in words."""
    return "all" if share == 1 else f"at least {percent(share, 'down')}"


def between(low, high, form=percent) -> str:
    """Return a range that contains both numbers, or one number if they are printed alike."""
    if form(low) == form(high):
        return form(low)
    return f"{form(low, bound='down').removesuffix(' %')} to {form(high, bound='up')}"


def listed(items) -> str:
    """Return words as a list in a sentence, such as "1.7, 1.85 and 1.95"."""
    *most, last = items
    return f"{', '.join(most)} and {last}" if most else last
