"""A flight whose distance to a wall is as small as rounding errors."""

import numpy as np
import pytest
from references import extended

from impact_damper.kernel.single import workspace
from impact_damper.kernel.tangents import advance

PARAMETERS = [1.5953653092347446, 0.215, 0.0, 1.0, 1.0, 0.0, 0.0, 0.625, 50.0, 2.5, *4 * [0.0]]
STATE = [-0.3200981905676796, -0.26859744176542183, -0.6249999999999999, -1.2260674298048002e-06]
BEGIN, END = 27.036899746777475, 27.1


@pytest.mark.skipif(bool(extended.obstacle()), reason=extended.obstacle() or "runs")
def test_a_flight_within_rounding_of_a_wall_ends_in_a_contact():
    """The bounds on the distance to the wall allow only the step 0. The contact is 1e-12 deep."""
    p, y = np.array(PARAMETERS), np.array(STATE)
    advance(p, y, np.empty((0, 4)), 0, BEGIN, END, 1e-12, workspace())
    exact = extended.run(p, STATE, BEGIN, [END]).states[-1]
    np.testing.assert_allclose(y, exact.astype(float), atol=1e-11)
