"""The gap with the smallest quiet orbit is a trap: hardly any start leads to this orbit.

The orbit is compared with the closed form for rigid walls, and shares of starts with binomial
bounds. The cliff is the gap at which the share of quiet starts falls from 1 to nearly 0.

A start is an initial state.
"""

from dataclasses import replace

import numpy as np
import pytest
from references.masri_caughey import stability_boundaries, two_impact_motions
from scipy.optimize import minimize_scalar
from scipy.stats import binomtest

import impact_damper as idm
from impact_damper.design.cliff import find_edges
from impact_damper.design.compare import compare
from impact_damper.design.outcomes import Case, are_quiet, run
from impact_damper.design.screen import screen
from impact_damper.design.task import Task

MACHINE = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.005, force=40)
TASK = Task(
    machine=MACHINE,
    mass=0.6,
    band=(20.3, 20.8),
    restitution=0.7,
    contact_stiffness=2e7,
    frequencies=3,
    candidates=4,
    starts=73,
)
# Starts at the gap of the smallest orbit.
MANY = 300


@pytest.fixture(scope="module")
def first_look():
    return screen(TASK)


def rigid_best(task):
    """Return the gap and displacement (mm) of the smallest stable motion between rigid walls.

    Also return the gap at which stable motions end (mm).
    """
    oscillator, damper, frequency = task.system(5e-3, MACHINE.natural_frequency)

    def smallest(clearance):
        motions = two_impact_motions(oscillator, replace(damper, clearance=clearance), frequency)
        return min((each.displacement for each in motions if each.stable), default=np.inf)

    boundaries = stability_boundaries(oscillator, damper, frequency)
    end = max(each.clearance for each in boundaries if each.event in ("neimark_sacker", "fold"))
    found = minimize_scalar(smallest, bounds=(0.5 * end, end), method="bounded")
    gaps = 2e3 * task.scales.to_si(np.array([found.x, end]), "clearance")
    return gaps[0], task.millimetres(found.fun), gaps[1]


@pytest.mark.parametrize(("stiffness", "error"), [(2e7, 0.05), (2e9, 0.005)])
def test_the_smallest_orbit_and_its_edge_are_those_of_rigid_walls(stiffness, error):
    task = replace(TASK, contact_stiffness=stiffness)
    best = screen(task).best
    gap, displacement, edge = rigid_best(task)
    assert best.gap == pytest.approx(gap, rel=error)
    assert best.displacement == pytest.approx(displacement, rel=error)
    assert best.edge == pytest.approx(edge, rel=error)


def quiet_starts(gap, count, limit):
    """Run starts at a gap (mm) at resonance; return which are quiet, and displacements (mm)."""
    cases = [Case(1e-3 * gap, MACHINE.natural_frequency)]
    records = run(TASK, cases, count, "unseen")[0]
    sizes = TASK.millimetres(records["maximum_displacement"])
    return are_quiet(sizes, records["outcome"], limit), sizes


def test_few_starts_reach_the_smallest_orbit_and_the_others_rattle(first_look):
    best = first_look.best
    quiet, sizes = quiet_starts(best.gap, MANY, 2 * best.displacement)
    bounds = binomtest(int(quiet.sum()), MANY).proportion_ci(0.99, "exact")
    assert bounds.low < 0.1 and bounds.high < 0.2
    assert np.median(sizes[~quiet]) > 4 * best.displacement


def test_a_little_below_it_every_start_ends_quiet(first_look):
    best = first_look.best
    quiet, sizes = quiet_starts(0.85 * best.gap, TASK.starts, 2 * best.displacement)
    assert quiet.all() and sizes.max() < 1.8 * best.displacement
    assert binomtest(TASK.starts, TASK.starts).proportion_ci(0.95, "wilson").low >= 0.95


def test_the_cliff_lies_between_them(first_look):
    best = first_look.best
    gaps = best.gap * np.array([0.85, 1.0])
    found = compare(
        TASK, gaps, [MACHINE.natural_frequency], 2 * best.displacement, TASK.starts, "candidates"
    )
    assert list(found.quiet) == [True, False]
    edge = find_edges(TASK, found, gaps[0])[1]
    assert gaps[0] <= edge.gap < edge.beyond <= gaps[1]
    assert edge.beyond / edge.gap == pytest.approx((gaps[1] / gaps[0]) ** (1 / 16))
    for gap, inside in ((0.99 * edge.gap, True), (1.03 * edge.beyond, False)):
        quiet, _ = quiet_starts(gap, TASK.starts, 2 * best.displacement)
        assert (quiet.mean() > 0.95) == inside
