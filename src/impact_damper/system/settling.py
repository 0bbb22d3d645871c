"""How long motions are run, and how accurately. This module imports no NumPy."""

from dataclasses import dataclass

from impact_damper.system.bounds import (
    FURTHER_RANGE,
    LIMIT_RANGE,
    PATIENCE_RANGE,
    TOLERANCE_RANGE,
    WATCHED_RANGE,
    check_count,
    check_number,
    shown,
)
from impact_damper.system.names import names_arguments


@names_arguments
@dataclass(frozen=True)
class Settling:
    """How long motions are run to find out whether they settle on an orbit, and how accurately.

    Attributes
    ----------
    tolerance : float
        Local error allowed in a step of the integrator, dimensionless.
    patience : int
        Forcing periods after which a motion is stopped if it is chaotic beyond doubt, or if the
        loose mass hardly moves and has touched no wall during these periods.
    limit : int
        Forcing periods after which every motion is stopped, as chaotic if that is certain, or as
        drifting if its loose mass has touched no wall for `patience` periods.
    watched : int
        Further forcing periods for which a motion that has not settled is run to measure it.
    further : int
        Most forcing periods for which a motion that is undecided at `limit` is run on, to find out
        whether it is quasi-periodic, periodic with a long period, or chaotic.
        A motion still undecided then is unresolved.

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
        check_number("tolerance", self.tolerance, **TOLERANCE_RANGE)
        check_count("patience", self.patience, **PATIENCE_RANGE)
        limits = LIMIT_RANGE | {"least": self.patience, "why": "not below patience"}
        check_count("limit", self.limit, **limits)
        check_count("watched", self.watched, **WATCHED_RANGE)
        check_count("further", self.further, **FURTHER_RANGE)


def check_settling(settling) -> Settling:
    """Return `settling`, or the default for None; raise TypeError if it is not a Settling."""
    if settling is None:
        return Settling()
    if not isinstance(settling, Settling):
        raise TypeError(f"settling = {shown(settling)}: must be a Settling")
    return settling
