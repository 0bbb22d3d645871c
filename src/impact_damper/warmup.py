"""Compile every kernel that the package calls, on problems of no size, and cache it."""

import numpy as np

from impact_damper.ensemble import Settling
from impact_damper.migration import trials
from impact_damper.motions import simulate
from impact_damper.parameters import Damper, Oscillator
from impact_damper.response import collisions, frequency_response


def warm_up() -> None:
    """Call each kernel once with the types that it is always called with."""
    oscillator, damper = Oscillator(damping=0.215), Damper(mass_ratio=0.12, clearance=2.0)
    settling = Settling(patience=100, limit=100, watched=1)
    simulate(oscillator, damper, 2.0, periods=1, samples=2)
    frequency_response(oscillator, damper, np.array([2.0, 2.01]), starts=1, settling=settling)
    collisions(oscillator, damper, 2.0, starts=1, periods=1)
    trials(oscillator, damper, 1.95, trials=1, releases=1, lifetime=100, longest_hold=5)
