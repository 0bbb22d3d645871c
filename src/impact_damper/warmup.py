"""Compile every kernel that the package calls, on problems of no size, and cache it."""

from impact_damper.ensemble import Settling
from impact_damper.migration import trials
from impact_damper.motions import simulate
from impact_damper.parameters import Damper, Oscillator
from impact_damper.response import collisions, frequency_response


def warm_up() -> None:
    """Call each kernel once with the types that it is always called with."""
    oscillator = Oscillator(damping=0.215)
    # With it every motion settles soon at this frequency, so that orbits are followed too.
    damper = Damper(mass_ratio=0.25, clearance=1.0, restitution=0.75)
    settling = Settling(patience=100, limit=100, watched=1)
    simulate(oscillator, damper, 1.95, periods=1, samples=2)
    frequency_response(oscillator, damper, [1.95, 1.96], starts=1, settling=settling)
    collisions(oscillator, damper, 1.95, starts=1, periods=1)
    trials(oscillator, damper, 1.95, trials=1, releases=1, lifetime=100, longest_hold=5)
