"""One contact of the damper in closed form, under a constant load, with two rules for its end.

While the loose mass touches a wall, equations (20) to (23) give the penetration q as

    q'' + 2 z wn q' + wn^2 q = g,   wn^2 = r1 (1 + 1/rm),   z = zeta_c sqrt(1 + rm),

where g is the acceleration of Z1 towards the wall by all other forces, which hardly changes
in so short a time. With s = wn t and u = wn q/v0, v0 the approach speed, this is

    u'' + 2 z u' + u = G,   u(0) = 0,   u'(0) = 1,   G = g/(wn v0):

the restitution e, which sets z by (25), and the load G decide everything. A positive load
presses the bodies together. The force of the wall is F = u + 2 z u'.

Exit rules: `zero_penetration` (appendix B) ends the contact where u = 0, and the wall may pull
before; `no_tension` ends it where F = 0.
"""

import math
from typing import NamedTuple

from scipy.optimize import brentq

from impact_damper.system.bounds import check_number

EXIT_RULES = ("zero_penetration", "no_tension")


class Exit(NamedTuple):
    """How a contact ends.

    Attributes
    ----------
    outcome : str
        "released"; "falls_back" if the loose mass leaves the wall, which cannot pull, but the load
        turns it before it is back at zero penetration; "no_release" if the contact does not end.
    duration : float
        wn t, infinite if the contact does not end.
    departure : float
        The realised restitution: speed back at zero penetration over approach speed, a free
        flight under the load from the end of the contact on included; NaN unless released.
    """

    outcome: str
    duration: float
    departure: float


class Tension(NamedTuple):
    """Pull of the wall before the penetration is zero again; NaN if the contact does not end.

    Attributes
    ----------
    time : float
        Share of the contact in which the wall pulls.
    impulse : float
        Impulse of the pull over that of the push.
    peak : float
        Largest pull over the largest push.
    """

    time: float
    impulse: float
    peak: float


class _Wave(NamedTuple):
    """The function level + exp(-z s) (a cos(w s) + b sin(w s)), w = sqrt(1 - z^2)."""

    level: float
    a: float
    b: float
    z: float
    w: float

    def __call__(self, s):
        decay = math.exp(-self.z * s)
        return self.level + decay * (self.a * math.cos(self.w * s) + self.b * math.sin(self.w * s))

    def slope(self):
        """Its derivative."""
        a, b, z, w = self.a, self.b, self.z, self.w
        return _Wave(0.0, w * b - z * a, -z * b - w * a, z, w)

    def first_extrema(self):
        """Where it is largest first, or 0 if it falls from the beginning, and the minimum next."""
        slope = self.slope()
        turn = math.atan2(-slope.a, slope.b) % math.pi or math.pi
        rising = slope.a > 0 or (slope.a == 0 and slope.b > 0)
        return (turn / self.w, (turn + math.pi) / self.w) if rising else (0.0, turn / self.w)

    def first_fall(self):
        """Where it falls to zero first, infinite if it does not: later minima are no deeper."""
        top, bottom = self.first_extrema()
        if self(bottom) > 0:
            return math.inf
        return brentq(self, top, bottom, xtol=1e-15, rtol=1e-14)


def damping_ratio(restitution) -> float:
    """Damping ratio z of the relative motion, from e = exp(-pi z/sqrt(1 - z^2))."""
    logarithm = math.log(1 / restitution)
    return logarithm / math.hypot(math.pi, logarithm)


def natural_frequency(damper) -> float:
    """wn = sqrt(r1 (1 + 1/rm)) of a `Damper`; half its period is the time of elastic contact."""
    return math.sqrt(damper.contact_stiffness * (1 + 1 / damper.mass_ratio))


def _waves(restitution, load):
    """Penetration u and force F of a contact."""
    check_number("restitution", restitution, above=0.0, most=1.0)
    check_number("load", load)
    z = damping_ratio(restitution)
    w = math.sqrt(1 - z * z)
    penetration = _Wave(load, -load, (1 - z * load) / w, z, w)
    force = _Wave(load, 2 * z - load, (1 + z * load - 2 * z * z) / w, z, w)
    return penetration, force


def contact(restitution, load, rule) -> Exit:
    """How a contact ends.

    Parameters
    ----------
    restitution : float
        e for which (25) sets the dashpot.
    load : float
        G = g/(wn v0), dimensionless.
    rule : str
        One of EXIT_RULES.

    Raises
    ------
    TypeError, ValueError
        If an argument is out of range.
    """
    if rule not in EXIT_RULES:
        raise ValueError(f"rule = {rule!r}: must be one of {', '.join(EXIT_RULES)}")
    penetration, force = _waves(restitution, load)
    end = (penetration if rule == "zero_penetration" else force).first_fall()
    if end == math.inf:
        return Exit("no_release", math.inf, math.nan)
    left = penetration(end) if rule == "no_tension" else 0.0
    square = penetration.slope()(end) ** 2 - 2 * load * left
    if square < 0:
        return Exit("falls_back", end, math.nan)
    return Exit("released", end, math.sqrt(square))


def tension(restitution, load) -> Tension:
    """How long, how much and how hard the wall pulls under the rule `zero_penetration`.

    The impulse of the wall between two instants is that of the load less the change of speed.
    """
    penetration, force = _waves(restitution, load)
    speed = penetration.slope()
    end = penetration.first_fall()
    if end == math.inf:
        return Tension(math.nan, math.nan, math.nan)
    begin = min(force.first_fall(), end)
    push = load * begin - (speed(begin) - 1)
    pull = speed(end) - speed(begin) - load * (end - begin)
    top, bottom = force.first_extrema()
    most = max(0.0, -force(end), -force(bottom) if bottom < end else 0.0)
    return Tension((end - begin) / end, pull / push, most / max(force(top), force(0.0)))
