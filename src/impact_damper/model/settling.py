"""Settings: length and accuracy of the runs in which motions settle."""

from dataclasses import dataclass

from impact_damper.model import bounds
from impact_damper.model.bounds import check_count, check_number, names_arguments, shown


@names_arguments
@dataclass(frozen=True)
class Settling:
    """Length and accuracy of the runs that show whether motions settle to an orbit.

    Attributes
    ----------
    tolerance : float
        Largest local error in a step of the integrator, dimensionless.
    patience : int
        Number of forcing cycles after which a run is stopped if the motion is chaotic with a
        Lyapunov exponent above 0.05 (per unit of T). A run is also stopped if three conditions
        hold: the primary mass is on an orbit, the loose mass has touched no wall for `patience`
        cycles, and it is so slow that `limit` cycles would move it by less than 1 % of the
        clearance.
    limit : int
        Number of forcing cycles after which every run that is left is judged. If chaos is certain,
        the outcome is chaotic. The outcome is drifting if two conditions hold: the primary mass is
        on an orbit, and the loose mass has touched no wall for `patience` cycles. Other motions are
        undecided.
    watched : int
        Number of extra forcing cycles in which an unsettled motion's displacement is measured.
    further : int
        Largest number of forcing cycles for which an undecided run is continued. The motion may
        then prove to be quasi-periodic, chaotic, or periodic with a long period.

    Raises
    ------
    TypeError, ValueError
        If a value is no number, or is out of range.

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
    """Return `settling`, or default settings if it is None. Another type raises TypeError."""
    if settling is None:
        return Settling()
    if not isinstance(settling, Settling):
        raise TypeError(f"settling = {shown(settling)}: must be a Settling")
    return settling
