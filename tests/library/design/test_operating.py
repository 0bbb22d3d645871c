"""Where the quiet orbit is stable over the force, by the law of similarity from the gap.

For a linear machine a force times s acts like a gap divided by s.
"""

import numpy as np
import pytest
from helpers.design_tasks import task

from impact_damper.design.operating import force_map
from impact_damper.design.quiet_branch import over_gap, quiet_orbit


@pytest.mark.parametrize("given", [{}, {"mass": 1.2, "restitution": 0.6}])
def test_forces_of_stability_are_gaps_of_stability_turned_round(given):
    made = task(frequencies=3, candidates=4, starts=73, **given)
    frequency = made.worst_frequency
    gap = 0.8e3 * made.rule_gap(frequency)
    orbit = quiet_orbit(made, gap, frequency)
    branch = over_gap(made, gap, frequency, orbit)
    found = force_map(made, gap, frequency, orbit, 2.0)
    place = int(np.argmin(np.abs(found["operating_frequency"].values - frequency)))
    forces = found["stability_force_by_frequency"].values[place]
    assert forces == pytest.approx(gap / branch["stability_gap"].values[::-1], rel=3e-4)
    stable = found["force_map_modulus"].values[place] < 1
    inside = (found["force_share"] >= forces[0]) & (found["force_share"] <= forces[1])
    np.testing.assert_array_equal(stable, inside)
