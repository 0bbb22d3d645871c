"""The gap with the smallest quiet orbit is a trap: hardly any start leads to this orbit.

The orbit is compared with the closed form for rigid walls, and shares of starts with binomial
bounds. The cliff is the gap at which the share of quiet starts falls from 1 to nearly 0.
"""

from dataclasses import replace

import numpy as np
import pytest
from helpers.design_tasks import MACHINE, task
from references.masri_caughey import stability_boundaries, two_impact_motions
from scipy.optimize import minimize_scalar
from scipy.stats import binomtest

from impact_damper.design.choose import quiet_gaps
from impact_damper.design.cliff import find_edges
from impact_damper.design.compare import compare
from impact_damper.design.outcomes import Case, are_quiet, run
from impact_damper.design.screen import screen

TASK = task(frequencies=3, candidates=4, starts=73)
# Starts at the gap of the smallest orbit.
MANY = 300


@pytest.fixture(scope="module")
def best():
    """Return gap and displacement (mm) of the smallest stable quiet orbit."""
    found = screen(TASK)
    return float(found["best_orbit_gap"]), float(found["best_orbit_displacement"])


def rigid_best(task):
    """Return gap and displacement (mm) of the smallest stable motion between rigid walls."""
    oscillator, damper, frequency = task.system(5e-3, MACHINE.natural_frequency)

    def smallest(clearance):
        motions = two_impact_motions(oscillator, replace(damper, clearance=clearance), frequency)
        return min((each.displacement for each in motions if each.stable), default=np.inf)

    boundaries = stability_boundaries(oscillator, damper, frequency)
    end = max(each.clearance for each in boundaries if each.event in ("neimark_sacker", "fold"))
    found = minimize_scalar(smallest, bounds=(0.5 * end, end), method="bounded")
    return 2e3 * task.scales.to_si(found.x, "clearance"), task.millimetres(found.fun)


@pytest.mark.parametrize(("stiffness", "error"), [(2e7, 0.05), (2e9, 0.005)])
def test_the_smallest_orbit_is_that_of_rigid_walls(stiffness, error):
    made = replace(TASK, contact=stiffness)
    best = screen(made)
    gap, displacement = rigid_best(made)
    assert best["best_orbit_gap"] == pytest.approx(gap, rel=error)
    assert best["best_orbit_displacement"] == pytest.approx(displacement, rel=error)


def quiet_starts(gap, count, limit):
    """Run starts at a gap (mm) at resonance; return which are quiet, and displacements (mm)."""
    cases = [Case(1e-3 * gap, MACHINE.natural_frequency)]
    records = run(TASK, cases, count, "unseen")[0]
    sizes = TASK.millimetres(records["maximum_displacement"])
    return are_quiet(sizes, records["outcome"], limit), sizes


def test_few_starts_reach_the_smallest_orbit_and_the_others_rattle(best):
    best_gap, best_size = best
    quiet, sizes = quiet_starts(best_gap, MANY, 2 * best_size)
    bounds = binomtest(int(quiet.sum()), MANY).proportion_ci(0.99, "exact")
    assert bounds.low < 0.1 and bounds.high < 0.2
    assert np.median(sizes[~quiet]) > 4 * best_size


def test_a_little_below_it_every_start_ends_quiet(best):
    best_gap, best_size = best
    quiet, sizes = quiet_starts(0.85 * best_gap, TASK.effort.starts, 2 * best_size)
    assert quiet.all() and sizes.max() < 1.8 * best_size
    assert (
        binomtest(TASK.effort.starts, TASK.effort.starts).proportion_ci(0.95, "wilson").low >= 0.95
    )


def test_the_cliff_lies_between_them(best):
    best_gap, best_size = best
    gaps = best_gap * np.array([0.85, 1.0])
    found = compare(
        TASK, gaps, [MACHINE.natural_frequency], 2 * best_size, TASK.effort.starts, "candidates"
    )
    assert list(quiet_gaps(found, TASK.share)) == [True, False]
    edge = find_edges(TASK, found, gaps[0])[1]
    assert gaps[0] <= edge.gap < edge.beyond <= gaps[1]
    assert edge.beyond / edge.gap == pytest.approx((gaps[1] / gaps[0]) ** (1 / 16))
    for gap, inside in ((0.99 * edge.gap, True), (1.03 * edge.beyond, False)):
        quiet, _ = quiet_starts(gap, TASK.effort.starts, 2 * best_size)
        assert (quiet.mean() > 0.95) == inside
