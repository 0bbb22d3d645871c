"""Columns with the parameters of a dataset."""

from impact_damper.data.datasets import parameters_of
from impact_damper.model.parameters import SYMBOLS


def parameter_columns(data, *names) -> dict:
    """Return the values of the named parameters of a dataset, keyed by the paper's symbols.

    Parameters that the dataset does not have are left out; without a damper, for example, there is
    no mass ratio.
    """
    parameters = parameters_of(data)
    return {SYMBOLS[name]: parameters[name] for name in names if name in parameters}
