"""Helpers of the tables: columns with the parameters of a dataset, and runs of True in an array."""

import numpy as np

from impact_damper.data.datasets import parameters_of
from impact_damper.model.parameters import SYMBOLS


def parameter_columns(data, *names) -> dict:
    """Return the values of the named parameters of a dataset, keyed by the paper's symbols.

    Parameters that the dataset does not have are left out; without a damper, for example, there is
    no mass ratio.
    """
    parameters = parameters_of(data)
    return {SYMBOLS[name]: parameters[name] for name in names if name in parameters}


def runs_of_true(mask) -> np.ndarray:
    """Return for each run of True its first index and the index after its last, shape (n, 2)."""
    return np.flatnonzero(np.diff(np.asarray(mask, int), prepend=0, append=0)).reshape(-1, 2)
