"""Numbers as words of a sentence; NaN is an unknown number."""

import math

# Of fewer things than this the number is told, of more the percentage.
FEW = 20


def number(value, digits=3) -> str:
    """A number with a few significant digits."""
    return "an unknown number" if math.isnan(value) else f"{value:.{digits}g}"


def percent(share) -> str:
    """A share as a percentage of two or three digits, which is 0 or 100 only if that is exact."""
    if math.isnan(share):
        return "an unknown share"
    if 0 < share < 0.0005:
        return "less than 0.1 %"
    if share == 1 or not 0.95 < share < 1:
        decimals = 0 if abs(share) >= 0.1 else 1
        return f"{100 * share:.{decimals}f}".removesuffix(".0") + " %"
    text = f"{100 * share:.{3 if share < 0.999 else 4}g}"
    return "more than 99.99 %" if text == "100" else f"{text} %"


def part_of(share, things, count=None) -> str:
    """A share of a plural, such as "81 % of the runs", "all runs", "none of the 400 runs"."""
    total = things if count is None else f"{count} {things}"
    if share == 1:
        return f"all {total}"
    if share == 0:
        return f"none of the {total}"
    if count is None or count > FEW or math.isnan(share):
        return f"{percent(share)} of the {total}"
    return f"{round(share * count)} of the {total}"


def least(share) -> str:
    """A lower bound of a share."""
    return "all" if share == 1 else f"at least {percent(share)}"


def between(low, high, form=percent) -> str:
    """Both ends of a range, or one of them if they look the same."""
    ends = [form(low), form(high)]
    return ends[0] if ends[0] == ends[1] else f"{ends[0].removesuffix(' %')} to {ends[1]}"


def listed(items) -> str:
    """Words as a list in a sentence, such as "1.7, 1.85 and 1.95"."""
    *most, last = items
    return f"{', '.join(most)} and {last}" if most else last
