"""A published number and the number computed by this package.

A start is an initial state.
"""

from typing import NamedTuple

import numpy as np


class Comparison(NamedTuple):
    """A published number, or a value of a published closed form, and this package's number.

    Attributes
    ----------
    publication : str
        A flag of the dataset variable `publication`.
    quantity : str
        Name of the quantity with its parameters, unique among all comparisons.
    published, ours : float
        The published number, and the number computed by this package.
    reason : str
        Reason why the two numbers differ, a flag of the dataset variable `difference_reason`. It
        may name a parameter on which the difference depends.
    order : float
        Exponent n of |ours - published| ~ parameter^n with this parameter; NaN if it is not varied.
    limit : float
        `ours` extrapolated to the limit in which the closed form holds (rigid walls); NaN without
        extrapolation.
    error : float
        Standard error of the difference, for numbers from random starts; NaN for other numbers.
    expected : float
        Expected size of ours/published - 1 for this reason; NaN if unknown.
    """

    publication: str
    quantity: str
    published: float
    ours: float
    reason: str
    order: float = np.nan
    limit: float = np.nan
    error: float = np.nan
    expected: float = np.nan


def observed_order(parameters, differences) -> float:
    """Return the exponent n of |difference| ~ parameter^n from the last two of each array."""
    (first, last), (before, after) = parameters[-2:], differences[-2:]
    return float(np.log(abs(after / before)) / np.log(last / first))
