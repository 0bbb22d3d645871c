"""Closed form of one contact under a constant load, with two rules for its end.

Time t and penetration q are scaled: s = wn t and u = wn q/v0. The motion is u'' + 2 z u' + u = G,
with the damping ratio z. `stages.contact_model` defines wn, v0 and the load G. The wall pushes with
the force F = u + 2 z u'. By the rule `zero_penetration` (appendix B) a contact ends when u = 0, by
`no_tension` when F = 0.
"""

import math
from typing import NamedTuple

from scipy.optimize import brentq

from impact_damper.model.exit_rules import damping_ratio


class Exit(NamedTuple):
    """End of a contact: its kind, duration x natural frequency, speed after / speed before."""

    outcome: str
    duration: float
    departure: float


class _Wave(NamedTuple):
    """The function level + exp(-z s) (a cos(w s) + b sin(w s)) of s, with w = sqrt(1 - z^2)."""

    level: float
    a: float
    b: float
    z: float
    w: float

    def __call__(self, s):
        decay = math.exp(-self.z * s)
        return self.level + decay * (self.a * math.cos(self.w * s) + self.b * math.sin(self.w * s))

    def slope(self):
        a, b, z, w = self.a, self.b, self.z, self.w
        return _Wave(0.0, w * b - z * a, -z * b - w * a, z, w)

    def first_extrema(self):
        """Return s at the first maximum (0 if the wave falls at first) and at the next minimum."""
        slope = self.slope()
        turn = math.atan2(-slope.a, slope.b) % math.pi or math.pi
        rising = slope.a > 0 or (slope.a == 0 and slope.b > 0)
        return (turn / self.w, (turn + math.pi) / self.w) if rising else (0.0, turn / self.w)

    def first_fall(self):
        """Return s at the first zero with a negative slope, or infinity if there is none."""
        top, bottom = self.first_extrema()
        return math.inf if self(bottom) > 0 else brentq(self, top, bottom, xtol=1e-15, rtol=1e-14)


def _waves(restitution, load):
    z = damping_ratio(restitution)
    w = math.sqrt(1 - z * z)
    penetration = _Wave(load, -load, (1 - z * load) / w, z, w)
    force = _Wave(load, 2 * z - load, (1 + z * load - 2 * z * z) / w, z, w)
    return penetration, force


def contact(restitution, load, rule) -> Exit:
    """Return the `Exit` of a contact. `rule`, one of EXIT_RULES, says when the contact ends."""
    penetration, force = _waves(restitution, load)
    end = (penetration if rule == "zero_penetration" else force).first_fall()
    if end == math.inf:
        return Exit("no_release", math.inf, math.nan)
    left = penetration(end) if rule == "no_tension" else 0.0
    square = penetration.slope()(end) ** 2 - 2 * load * left
    if square < 0:
        return Exit("falls_back", end, math.nan)
    return Exit("released", end, math.sqrt(square))


def pull_time(restitution, load) -> float:
    """Return the fraction of a contact in which the wall pulls; NaN if the contact never ends."""
    penetration, force = _waves(restitution, load)
    end = penetration.first_fall()
    return math.nan if end == math.inf else (end - min(force.first_fall(), end)) / end
