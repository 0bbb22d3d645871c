"""The promised displacement: against closed forms, against a brute force, and by another program.

The other program computes in 80-bit arithmetic and shares no code with the package.
"""

import numpy as np
import pytest
from helpers.design_tasks import task
from references.extended import obstacle, run
from scipy.stats import binom

import impact_damper as idm
from impact_damper.data.shares import bounding_rank, starts_needed
from impact_damper.design.cells import Cell
from impact_damper.design.cells import run as run_cells
from impact_damper.design.promise import Promise, beside_peak, gap_sets, is_peak_known
from impact_damper.motions.simulate import random_states

HARDENING = idm.Machine(
    mass=20, linear_stiffness=1.5e5, cubic_stiffness=8e8, damping_ratio=0.004, force=60
)
BOARD = idm.Machine(
    mass=0.35, linear_stiffness=4.477e5, damping_ratio=0.01111, base_acceleration=3 * 9.80665
)
PUMP = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
# Machine and damper, band, gap (mm), and displacement (mm) below which starts are known to stay.
EXAMPLES = {
    "hardening": (
        {"machine": HARDENING, "mass": 1.2, "restitution": 0.8, "contact": 1e7},
        {"band": (17.5, 18.5), "tolerances": {"gap": 0.05}},
        22.0,
        2.3,
    ),
    "board": (
        {"machine": BOARD, "mass": 0.015, "restitution": 0.7, "contact": 1e7},
        {"band": (165, 195), "tolerances": {"gap": 0.2}},
        0.85,
        0.9,
    ),
    "pump": (
        {"machine": PUMP, "mass": 1.2, "restitution": 0.6, "contact": 2e7},
        {"band": (20, 21), "tolerances": {"gap": 0.15}},
        3.8,
        2.75,
    ),
    "lighter": (
        {"machine": PUMP, "mass": 0.6, "restitution": 0.7, "contact": 2e7},
        {"band": (20.3, 20.8), "tolerances": {"gap": 0.02}},
        7.91,
        2.4,
    ),
}
# New starts of the other program, cycles after which it measures, and cycles in which it does.
NEW, SETTLING, MEASURED = 5, 500, 40


@pytest.mark.parametrize("share", [0.8, 0.95, 0.99])
def test_a_rank_bounds_the_share(share):
    """The k-th largest of n values is below the quantile if fewer than k values exceed it."""
    for total in range(starts_needed(share) - 1, 400, 7):
        k = bounding_rank(share, total)
        assert k == 0 or binom.cdf(k - 1, total, 1 - share) <= 0.05
        assert binom.cdf(k, total, 1 - share) > 0.05
    assert [bounding_rank(0.95, n) for n in (58, 59, 92, 93, 123, 124)] == [0, 1, 1, 2, 2, 3]


def test_a_rank_bounds_the_quantile_of_drawn_values():
    """Of bounds from 96 exponentially distributed values, 95 % exceed the true quantile."""
    values = np.random.default_rng(1).exponential(size=(4000, 96))
    bounds = np.sort(values, axis=1)[:, -bounding_rank(0.95, 96)]
    assert np.mean(bounds > -np.log(0.05)) == pytest.approx(binom.sf(1, 96, 0.05), abs=0.01)


def test_the_peak_of_a_resonance_is_found_between_points():
    """Linear machine: intervals are split until the peak of the closed form is known to 1 %."""

    def size(f):
        return 1 / np.hypot(1 - f**2, 0.02 * f)

    frequencies, before = np.linspace(0.93, 1.09, 9), 0.0
    for _ in range(12):
        sizes = size(frequencies)
        if is_peak_known(frequencies, sizes, before):
            break
        before, frequencies = sizes.max(), np.union1d(frequencies, beside_peak(frequencies, sizes))
    assert sizes.max() == pytest.approx(50, rel=0.011)


@pytest.mark.thorough
@pytest.mark.skipif(bool(obstacle()), reason=obstacle() or "runs")
@pytest.mark.parametrize("name", EXAMPLES)
def test_new_starts_of_another_program_keep_the_promise(name):
    damper, asked, gap, known = EXAMPLES[name]
    made = task(**damper, **asked, frequencies=3, candidates=4, starts=59)
    found = Promise(made, 1e-3 * gap, gap_sets(made, gap), ("confirmed", 0)).refined()
    assert found.size < known
    k, frequency = found.worst
    p = made.packed(1e-3 * gap, frequency, tuple(found.sets[k]))
    _, scaled, turning = made.system(1e-3 * gap, frequency)
    period = 2 * np.pi / turning
    times = period * np.array([SETTLING, SETTLING + MEASURED])
    exceeded = 0
    for state in random_states(NEW, 2.0, scaled, 7):
        largest = np.abs(run(p, state, 0.0, times).extremes[1]).max()
        exceeded += made.millimetres(float(largest)) > found.size
    assert exceeded <= binom.ppf(0.999, NEW, 0.05)


def test_motions_of_one_regime_have_one_record_that_new_starts_keep():
    """Beyond the cliff all starts lead to chaos; new ones keep the bound for 1500 cycles."""
    cell, made = Cell(10e-3, 20.55), task(frequencies=3, candidates=4, starts=59)
    motions = run_cells(made, [cell], 59, ("search",))
    (bound,) = motions.largest(1)
    sizes, known = motions.numbers(0)
    for regime in motions.regimes(0):
        assert len(np.unique(sizes[regime])) == 1 and known[regime].all()
    others = run_cells(made, [cell], 60, ("compared",))
    while others.cycles[0] < 1500:
        others.follow(np.array([0]))
    assert np.sum(others.peaks > bound) <= binom.ppf(0.999, 60, 0.05)
