"""A published number beside the one computed here, and how fast their difference vanishes."""

from typing import NamedTuple

import numpy as np


class Comparison(NamedTuple):
    """A published number, or that of a published closed form, and the number computed here.

    Attributes
    ----------
    publication : str
        A flag of the variable `publication`.
    quantity : str
        What is compared, with its parameters; unique.
    published, ours : float
        The published number and the one computed here.
    reason : str
        Why the two numbers differ, a flag of the variable `difference_reason`.
    order : float
        Exponent n of |ours - published| ~ parameter^n, where `reason` names the parameter; NaN if
        that parameter is not varied.
    limit : float
        `ours` extrapolated to the limit in which the closed form holds (rigid walls); NaN if it is
        not extrapolated.
    error : float
        Standard error of the difference of numbers found by random starts; NaN for other numbers.
    expected : float
        Size of ours/published - 1 that is to be expected for this reason; NaN if it is not known.
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
    """Return the exponent n of |difference| ~ parameter^n, from the last two parameters given."""
    (first, last), (before, after) = parameters[-2:], differences[-2:]
    return float(np.log(abs(after / before)) / np.log(last / first))
