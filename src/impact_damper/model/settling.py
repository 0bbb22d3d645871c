"""Settings that state how long and how accurately motions are run.

This module imports no NumPy, because Snakemake reads it at every dry run.
"""

from dataclasses import dataclass

from impact_damper.model import bounds
from impact_damper.model.bounds import check_count, check_number, names_arguments, shown


@names_arguments
@dataclass(frozen=True)
class Settling:
    """How long motions are run to find out whether they settle to an orbit, and how accurately.

    Attributes
    ----------
    tolerance : float
        Largest local error in a step of the integrator, dimensionless.
    patience : int
        Forcing cycles after which a motion is stopped if it is certainly chaotic, or if the loose
        mass hardly moves and has touched no wall during these cycles.
    limit : int
        Forcing cycles after which every motion is stopped. It is then chaotic if it certainly is,
        drifting if the loose mass has touched no wall for `patience` cycles, otherwise undecided.
    watched : int
        Further forcing cycles in which the displacement of a motion that has not settled is
        measured.
    further : int
        Largest number of further forcing cycles of an undecided motion, to find out whether it is
        quasi-periodic, periodic with a long period, or chaotic; if it is none, it is unresolved.

    Raises
    ------
    TypeError, ValueError
        If a value is not a number or out of range.

    Examples
    --------
    >>> Settling(patience=3000, limit=20_000).tolerance
    1e-09
    """

    tolerance: float = 1e-9
    patience: int = 300
    limit: int = 1500
    watched: int = 50
    further: int = 100_000

    def __post_init__(self):
        check_number("tolerance", self.tolerance, **bounds.TOLERANCE_RANGE)
        check_count("patience", self.patience, **bounds.PATIENCE_RANGE)
        limits = bounds.LIMIT_RANGE | {"least": self.patience, "why": "not below patience"}
        check_count("limit", self.limit, **limits)
        check_count("watched", self.watched, **bounds.WATCHED_RANGE)
        check_count("further", self.further, **bounds.FURTHER_RANGE)


def check_settling(settling) -> Settling:
    """Return `settling`, or the default for None; raise TypeError if it is not a Settling."""
    if settling is None:
        return Settling()
    if not isinstance(settling, Settling):
        raise TypeError(f"settling = {shown(settling)}: must be a Settling")
    return settling
