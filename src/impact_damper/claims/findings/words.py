"""Numbers as words of a sentence; NaN is an unknown number."""

import math


def number(value, digits=3) -> str:
    """A number with a few significant digits."""
    return "an unknown number" if math.isnan(value) else f"{value:.{digits}g}"


def percent(share) -> str:
    """A share as a percentage, with a decimal below 10 % and above 95 %; 0 and 1 stay exact."""
    if math.isnan(share):
        return "an unknown share"
    if 0 < share < 0.0005:
        return "less than 0.1 %"
    if 0.9995 < share < 1:
        return "more than 99.9 %"
    rough = 0.1 <= abs(share) <= 0.95 or abs(share) > 1
    return f"{100 * share:.{0 if rough else 1}f}".removesuffix(".0") + " %"


def part_of(share, things) -> str:
    """A share of a plural, such as "81 % of the runs", "all of the runs", "none of the runs"."""
    return f"{ {0: 'none', 1: 'all'}.get(share, percent(share)) } of {things}"


def widening(ratio) -> str:
    """Smallest ratio of successive widths, as a verb with its object."""
    if math.isnan(ratio):
        return "changes by an unknown share"
    if ratio >= 1:
        return f"widens by at least {percent(ratio - 1)}"
    return f"narrows by up to {percent(1 - ratio)}"


def between(low, high, form=percent) -> str:
    """Two ends of a range, which are named once if they look the same."""
    ends = [form(low), form(high)]
    return ends[0] if ends[0] == ends[1] else f"{ends[0].removesuffix(' %')} to {ends[1]}"
