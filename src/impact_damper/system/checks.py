"""Checks of frequencies and of sequences of numbers.

Their errors name the argument, its value and the allowed range.
"""

import numpy as np

from impact_damper.system.bounds import (
    FREQUENCY_RANGE,
    MOST_RUNS,
    check_count,
    check_number,
    shown,
)


def check_numbers(name, values, **bounds):
    """Return a number or a sequence of numbers as an array; `bounds` as of `check_number`.

    Raises
    ------
    TypeError, ValueError
        If a number is not allowed. The message names its index.
    """
    return np.array([check_number(f"{name}[{i}]", x, **bounds) for i, x in _numbered(values)])


def check_counts(name, values, **bounds):
    """Return whole numbers as an array; do as `check_numbers`, but with `check_count`."""
    return np.array([check_count(f"{name}[{i}]", x, **bounds) for i, x in _numbered(values)], int)


def _numbered(values):
    return enumerate(values if isinstance(values, (list, tuple)) else np.atleast_1d(values))


def check_frequency(value):
    """Return the forcing frequency W as a float, or raise an error if it is out of range."""
    return check_number("frequency", value, **FREQUENCY_RANGE)


def check_increasing(name, values, least="one"):
    """Return increasing numbers as an array.

    Raises
    ------
    ValueError
        If the numbers do not increase, or are fewer than `least`, which is "one" or "two".
    """
    numbers = check_numbers(name, values)
    if len(numbers) < {"one": 1, "two": 2}[least] or np.any(np.diff(numbers) <= 0):
        given = shown(numbers.tolist())
        raise ValueError(f"{name} = {given}: must be increasing, and at least {least}")
    return numbers


def check_frequencies(values, least="one"):
    """Return forcing frequencies as an array, or raise unless they increase and are in range."""
    return check_increasing(
        "frequencies", check_numbers("frequencies", values, **FREQUENCY_RANGE), least
    )


def check_starts(starts, points, least=1):
    """Raise an error if the records of `starts` runs at each of `points` points exceed memory."""
    most = max(least, MOST_RUNS // points)
    check_count("starts", starts, least=least, most=most, why=f"at {points} points: memory")


def check_span(name, span, **bounds) -> tuple:
    """Return the least and the greatest value of a range; `bounds` hold for each of them.

    Raises
    ------
    TypeError, ValueError
        If an end is not a number or not allowed, or the ends are not in order.
    """
    ends = check_numbers(name, span, **bounds)
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise ValueError(f"{name} = {shown(span)}: must be least and greatest value")
    return float(ends[0]), float(ends[1])
