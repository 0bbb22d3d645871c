"""Entry of the registry, and flags used by several variables."""

from typing import NamedTuple


class Variable(NamedTuple):
    """One variable of the datasets.

    Attributes
    ----------
    dims : tuple of str
        Default dimensions.
    long_name : str
        Description; also the words of an axis label.
    symbol : str
        Symbol of the paper, or "".
    units : str
        "1": a dimensionless number, scaled as in section 2.1 of the paper. "radian": an angle.
    flags : dict of int or None
        For a variable with named values: the stored number of each name; otherwise None.
    quantity : str
        Physical quantity, which decides the conversion to SI units: a key of
        `machine.units.QUANTITIES`; "state" for displacements and velocities; "followed" for the
        parameter that a sweep or a branch varies; "mixed" for a number that combines several
        quantities, such as the distance of two states.
    """

    dims: tuple
    long_name: str
    symbol: str = ""
    units: str = "1"
    flags: dict | None = None
    quantity: str = "number"


STABILITY = {"absent": -2, "unstable": -1, "marginal": 0, "stable": 1}
# Outcome of a motion:
# absent          there is no motion in this place of the array
# unresolved      the run ended before the outcome was certain
# settled         on a stable periodic orbit, with contacts or without a damper
# diverged        the state is no longer finite
# non_colliding   settled, and the loose mass touches no wall
# escaped         over the barrier of a softening spring
# at_rest         a motion without forcing has come to rest
# drifting        the primary mass is on an orbit; the loose mass drifts and touched no wall so far
OUTCOME = {
    "absent": -1,
    "unresolved": 0,
    "settled": 1,
    "chaotic": 2,
    "diverged": 3,
    "non_colliding": 4,
    "escaped": 5,
    "at_rest": 6,
    "quasi_periodic": 7,
    "drifting": 8,
}
# Kind of a minimum: with a horizontal tangent, at a kink, at the end of a branch (jump), or at the
# end of the sweep (edge).
MINIMUM = {"not_found": 0, "smooth": 1, "kink": 2, "jump": 3, "edge": 4}
# Kinds of motions with the damper. A motion of period 1 is quiet if its largest displacement is
# below the quiet limit, half the displacement of the free resonance, and violent otherwise. A
# motion of another period is a subharmonic, whatever its size.
DAMPED_MOTION = {"none": -1, "unsettled": 0, "quiet": 1, "violent": 2, "subharmonic": 3}
# Kinds of motions without the damper.
FREE_MOTION = {
    "none": -1,
    "unresolved": 0,
    "non_resonance": 1,
    "resonance": 2,
    "subharmonic": 3,
    "other": 4,
}
# Events that end a branch of motions.
END = {
    "not_smooth": 0,
    "fold": 1,
    "symmetry_breaking": 2,
    "period_doubling": 3,
    "neimark_sacker": 4,
}
SUBHARMONIC_END = END | {"sweep_ends": 5, "not_found": 6}
SUPPRESSION = {"no_subharmonic_without_damper": 0, "removed": 1, "reduced": 2, "unchanged": 3}
