"""Suppression bands and pieces of branches, in invented data and against simulated motions."""

import numpy as np
import pytest
from helpers.changes import unstable
from helpers.made_up import PEAKS, world

from chatterjee1995.reading import datasets as reading
from chatterjee1995.reading import orbits
from chatterjee1995.reading.bands import suppression_band
from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Oscillator
from impact_damper.motions.steady import steady_motion
from impact_damper.orbits.orbit_branches import orbit_branches


@pytest.fixture
def data():
    return world()


def test_the_band_begins_above_the_last_violent_motion(data):
    """The W at which chaotic motions end is known only within a step of the grid of W."""
    peak = PEAKS[0.215]
    band = suppression_band(data, "figure_05a")
    assert (band.lower, band.width, band.resolution) == pytest.approx((0.95 * peak, 0.05 * peak, 0))
    response = data["response"]["figure_05a"]
    chaos = np.abs(response.frequency / peak - 0.96) < 0.001
    wild = response.assign(
        outcome=response.outcome.where(~chaos, flag("outcome", "chaotic")),
        maximum_displacement=response.maximum_displacement.where(~chaos, 2.0),
        contacts=response.contacts.where(~chaos, 4.0),
    )
    band = suppression_band(data | {"response": {"figure_05a": wild}}, "figure_05a")
    assert (band.lower, band.least_width) == pytest.approx((0.96 * peak, 0.035 * peak))


def test_a_quiet_orbit_is_stable_and_smaller_than_half_the_resonance(data):
    quiet = orbits.quiet(*orbits.of_curve(data, "figure_05a"))
    assert orbits.ranges(quiet) == [pytest.approx([1.0, 3.0])]
    high = orbits.high(*orbits.of_curve(data, "figure_05a"))
    assert orbits.covered(high, 1.5, 2.0) == pytest.approx(0.4)
    unstable("figure_05a", 0.8, 0.9)(data)
    broken = orbits.ranges(orbits.quiet(*orbits.of_curve(data, "figure_05a")))
    assert np.ravel(broken) == pytest.approx([1.0, 1.6, 1.8, 3.0], abs=0.02)


def test_between_neighbouring_orbits_a_straight_line_is_close():
    """Interpolated orbits agree with simulated motions, and stable parts end at the folds."""
    oscillator, span = Oscillator(damping=0.215), (1.2, 2.6)
    free = orbit_branches(oscillator, None, 1.8, (2.2, 0.1), span=span)
    part = orbits.pieces(free)
    part = part[part.stable]
    end, _ = orbits.resonance_fold(free)
    assert orbits.ranges(part[part["size"] > 1.2]) == [pytest.approx([span[0], end])]
    first = float(free.event_value.min())
    assert orbits.ranges(part[part["size"] < 1.2]) == [pytest.approx([first, span[1]])]
    for frequency in (1.51, 1.77):
        motion = steady_motion(oscillator, None, frequency, (2.2, 0.1))
        size = orbits.resonance(free, [frequency])
        assert size == pytest.approx(float(motion.maximum_displacement), rel=1e-3)
    assert np.isnan(orbits.resonance(free, [2.2]))


def test_unknown_dataset_is_named():
    with pytest.raises(reading.Missing, match="no dataset harmonic_balance/figure_05a"):
        reading.get({}, "harmonic_balance", "figure_05a")
