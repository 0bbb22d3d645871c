"""Checks of frequencies and of sequences of numbers.

The messages of their errors name the argument, its value and the allowed range.
"""

import numpy as np

from impact_damper.model.bounds import FREQUENCY_RANGE, MOST_RUNS, check_count, check_number, shown


def check_numbers(name, values, **bounds):
    """Return a number or a sequence of numbers as an array, shape (m,).

    `check_number` checks each number; `bounds` are its keyword arguments.

    Raises
    ------
    TypeError, ValueError
        If a number is not allowed. The message names the index of the number.
    """
    return np.array([check_number(f"{name}[{i}]", x, **bounds) for i, x in _numbered(values)])


def check_counts(name, values, **bounds):
    """Return whole numbers as an array of int, shape (m,), each checked by `check_count`."""
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
        If the numbers do not increase, or if there are too few. At least one or two are needed;
        `least` is "one" or "two".
    """
    numbers = check_numbers(name, values)
    if len(numbers) < {"one": 1, "two": 2}[least] or np.any(np.diff(numbers) <= 0):
        text = shown(numbers.tolist())
        number = f"{least} value{'s' * (least == 'two')}"
        raise ValueError(f"{name} = {text}: must be increasing, and at least {number}")
    return numbers


def check_frequencies(values, least="one"):
    """Return forcing frequencies as an array, checked to increase and to be in FREQUENCY_RANGE."""
    return check_increasing(
        "frequencies", check_numbers("frequencies", values, **FREQUENCY_RANGE), least
    )


def check_starts(starts, points, least=1):
    """Check the number of random starts at each of `points` grid points.

    Raises
    ------
    TypeError, ValueError
        If `starts` is not a whole number, is below `least`, or makes more than MOST_RUNS runs at
        all points together.
    """
    most = max(least, MOST_RUNS // points)
    check_count("starts", starts, least=least, most=most, why=f"memory holds {MOST_RUNS} runs")


def check_span(name, span, **bounds) -> tuple:
    """Return the least and the greatest value of a range as a tuple of two floats.

    The `bounds`, keyword arguments of `check_number`, hold for both values.

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or not allowed, or if the first is not below the second.
    """
    ends = check_numbers(name, span, **bounds)
    if ends.shape != (2,) or not ends[0] < ends[1]:
        raise ValueError(f"{name} = {shown(span)}: must be two numbers, least and greatest")
    return float(ends[0]), float(ends[1])
