"""The gap of the smallest orbit of a linear machine at resonance, in closed form.

`docs/explanation/trap.md` derives the form from the balance of first harmonics, at the fold of the
motion with two impacts in each cycle.
"""

import numpy as np
import pytest
from references.masri_caughey import two_impact_motions

from impact_damper.model.parameters import Damper, Oscillator


@pytest.mark.parametrize("restitution", [0.7, 0.8, 0.9])
@pytest.mark.parametrize("mass", [0.005, 0.02])
def test_the_smallest_orbit_lies_at_the_fold(mass, restitution):
    """The relative error is within 2 rm of motions between rigid walls, for e of 0.7 or more."""
    damping_ratio = 0.1 * mass
    s = (1 - restitution) / (1 + restitution)
    q = np.pi**2 / 4 + s**2
    root = 2 * np.hypot(damping_ratio * s + np.pi * mass / (2 * q), mass * s / q)
    gaps = np.linspace(0.95, 1.05, 201) * np.sqrt(q) / root
    oscillator = Oscillator(2 * damping_ratio, 1.0, cubic=0.0)
    sizes = []
    for gap in gaps:
        found = two_impact_motions(oscillator, Damper(mass, gap, restitution), 1.0)
        sizes.append(min((each.displacement for each in found if each.room > 0), default=np.inf))
    assert abs(gaps[np.argmin(sizes)] / (np.sqrt(q) / root) - 1) < 2 * mass + 1e-3
    assert abs(np.min(sizes) / (s / root) - 1) < 2 * mass
