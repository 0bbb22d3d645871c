"""One number of ours beside a published one, and how fast their difference vanishes."""

from typing import NamedTuple

import numpy as np


class Comparison(NamedTuple):
    """A published number, or that of a published closed form, and ours.

    Attributes
    ----------
    publication : str
        A flag of the variable `publication`.
    quantity : str
        What is compared, with its parameters; unique.
    published, ours : float
    reason : str
        Why they differ, a flag of the variable `difference_reason`.
    order : float
        Exponent with which the difference falls with the parameter that the reason names; NaN if
        that parameter is not varied.
    limit : float
        Our value extrapolated to the limit that the closed form is for; NaN if it is not.
    error : float
        Standard error of the difference, of numbers found by random starts; NaN for others.
    """

    publication: str
    quantity: str
    published: float
    ours: float
    reason: str
    order: float = np.nan
    limit: float = np.nan
    error: float = np.nan


def observed_order(parameters, differences) -> float:
    """Return the exponent n of |difference| ~ parameter^n between the last two of several."""
    (first, last), (before, after) = parameters[-2:], differences[-2:]
    return float(np.log(abs(after / before)) / np.log(last / first))
