"""Runs of the controller of figure 17: consistent totals, and releases compared with SciPy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import solve_ivp

from chatterjee1995.stages.releases import migration, release_scan
from impact_damper.data.datasets import flag
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling

CUBIC = Oscillator(0.215)
PAPER = Damper(0.12, 2.0)
SMALL = {"trials": 20, "releases": 40, "lifetime": 1000, "longest_hold": 20}


@pytest.fixture(scope="module")
def runs():
    return migration(CUBIC, PAPER, 1.85, **SMALL, settling=Settling())


@pytest.mark.parametrize("row", [1, 2])
def test_releases(runs, row):
    """Releases from the quiet motion and from period 3 lead to the motions of SciPy's runs."""
    maxima = {}
    for k in range(0, 40, 4):
        begin = (float(runs.release_phase[row, k]) % 1 + 0.25) * 2 * np.pi / 1.85
        state = [float(runs[f"release_{name}"][row, k]) for name in ("displacement", "velocity")]
        times = begin + np.linspace(200, 230, 3000)
        free = solve_ivp(
            lambda t, y: (y[1], np.cos(1.85 * t) - CUBIC.damping * y[1] - y[0] ** 3),
            *((begin, times[-1]), state, "DOP853", times),
            rtol=1e-10,
            atol=1e-11,
        )
        maxima.setdefault(int(runs.release_destination[row, k]), []).append(np.abs(free.y[0]).max())
    for name, displacement in (("non_resonance", 0.29604), ("subharmonic", 0.84606)):
        assert_allclose(
            maxima.pop(flag("destination", name), displacement), displacement, atol=1e-3
        )
    assert not maxima


def test_release_scan():
    """Releases from the quiet motion lead to period 3 at W = 1.73. It does not exist at W = 1.7."""
    small = {"starts": 16, "releases": 10, "lifetime": 60, "settling": Settling()}
    scan = release_scan(CUBIC, PAPER, [1.7, 1.73], **small)
    quiet = scan.damped_kind == flag("damped_kind", "quiet")
    assert_array_equal(quiet.sum("damped"), [1, 1])
    shares = scan.release_share.sel(bound="share").where(quiet).sum("damped")
    assert_array_equal(shares.sel(free_motion="non_resonance"), [1, 0])
    assert_array_equal(shares.sel(free_motion="subharmonic"), [0, 1])
