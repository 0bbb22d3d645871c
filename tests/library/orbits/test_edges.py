"""Edges of stability compared with bifurcations on branches, closed forms, and limits.

An edge is a curve in the plane of two parameters on which a symmetric orbit loses its stability.

Z2 is the displacement of the primary mass relative to the loose mass, W the forcing frequency and
d0 the clearance.
"""

from dataclasses import replace

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER, polished_orbit
from helpers.symmetric import CENTRAL, converged, linear_orbit
from numpy.testing import assert_allclose
from scipy.optimize import minimize_scalar

from chatterjee1995.comparisons.masri_caughey import flight_with_speed
from chatterjee1995.comparisons.masri_caughey_stability import stability_boundaries
from impact_damper.model.packed import CLEARANCE, pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.orbits.branches import follow_branch
from impact_damper.orbits.edge_curves import follow_edge
from impact_damper.orbits.edge_maps import map_edges
from impact_damper.orbits.edge_problem import FOLD, GRAZING, KINDS, SYMMETRY, TORUS, Problem
from impact_damper.orbits.quiet_orbits import straight_flight_end
from impact_damper.orbits.shooting import find_orbit

# A linear machine with the static deflection 1, forced at its resonance.
MACHINE = Oscillator(0.01, 1.0, cubic=0.0)
DAMPER = Damper(0.05, 20.0, restitution=0.7, contact_stiffness=100.0)


def paper(frequency, clearance):
    return pack(PAPER, replace(DESIGN, clearance=clearance), frequency)


def machine(clearance, restitution):
    return pack(MACHINE, replace(DAMPER, clearance=clearance, restitution=restitution), 1.0)


@pytest.fixture(scope="module")
def paper_orbit():
    known = polished_orbit("design")
    found = find_orbit(known.parameters, known.state)
    return converged(known.parameters, found.state, found.phase, True)


@pytest.fixture(scope="module")
def machine_orbit():
    return linear_orbit(MACHINE, DAMPER, 1.0, 0.68)


@pytest.fixture(scope="module")
def machine_map(machine_orbit):
    axes = np.linspace(7.0, 43.0, 13), np.linspace(0.3, 0.95, 8)
    return map_edges(machine, machine_orbit, (machine_orbit.p[CLEARANCE], 0.7), axes)


@pytest.fixture(scope="module")
def paper_map(paper_orbit):
    axes = np.linspace(1.0, 2.5, 16), np.linspace(1.4, 2.6, 7)
    return map_edges(paper, paper_orbit, (2.0, 2.0), axes)


def edge_of(edge_map, kind):
    (edge,) = [edge for edge in edge_map.edges if edge.kind == kind]
    return edge


def at_end(edge, bound):
    """First parameter at the end of an edge at which the second parameter reaches its bound."""
    (k,) = [k for k in (0, -1) if edge.values[k, 1] == bound]
    assert edge.ends[k] == "range_ends"
    return edge.values[k, 0]


def branch_at(family, edge_map, column, span):
    """Branch over the first parameter, from the most stable orbit in a column of a map."""
    row = int(np.nanargmin(edge_map.modulus[:, column]))
    first, second = edge_map.axes[0][row], edge_map.axes[1][column]
    return follow_branch(
        lambda value: family(value, second), edge_map.orbits[row, column], first, span
    )


def assert_located(branch, kind, found):
    """Check that an event of this kind on the branch lies at the parameter `found`."""
    events = np.array([event.point.value for _, event in branch.events if event.kind == kind])
    assert np.min(np.abs(events - found)) < 1e-7 * found


def test_folds_located_in_one_parameter(paper_map):
    second = paper_map.axes[1][-1]
    branch = branch_at(paper, paper_map, 6, (1.0, 2.0))
    assert_located(branch, FOLD, at_end(edge_of(paper_map, FOLD), second))


@pytest.mark.parametrize("column", [0, 7])
def test_edges_of_the_machine_located_in_one_parameter(machine_map, column):
    branch = branch_at(machine, machine_map, column, (10.0, 35.0))
    for kind in (TORUS, SYMMETRY):
        found = at_end(edge_of(machine_map, kind), machine_map.axes[1][column])
        assert_located(branch, kind, found)


def test_the_loose_mass_grazes_a_wall(machine_map):
    """On a grazing edge |Z2| has a maximum equal to the clearance, found here by minimization."""
    edge = edge_of(machine_map, GRAZING)
    assert len(edge.orbits) > 5
    for orbit in edge.orbits:
        phases = orbit.phase + np.linspace(0, 2 * np.pi, 400)
        reach = np.array([abs(orbit.at(phase)[2]) for phase in phases]) - orbit.p[CLEARANCE]
        inner = (reach[1:-1] > reach[:-2]) & (reach[1:-1] > reach[2:])
        k = np.flatnonzero(inner & (np.abs(reach[1:-1]) < 0.01))[0] + 1
        turn = minimize_scalar(
            lambda phase, orbit=orbit: -abs(orbit.at(phase)[2]),
            bounds=phases[[k - 1, k + 1]],
            method="bounded",
        )
        assert_allclose(-turn.fun, orbit.p[CLEARANCE], rtol=1e-9)


def test_a_contact_begins_on_a_branch_where_the_map_has_it(machine_map):
    """The branch, which is followed with other equations, has a grazing event on the edge."""
    found = at_end(edge_of(machine_map, GRAZING), machine_map.axes[1][0])
    branch = branch_at(machine, machine_map, 0, (found - 0.1, 35.0))
    assert_located(branch, "grazing", found)


def test_every_change_of_stability_of_the_map_has_an_edge(machine_map, paper_map):
    for edge_map in (machine_map, paper_map):
        assert edge_map.lost == 0
        stable = edge_map.modulus < 1
        changes = list(zip(*np.nonzero(stable[:-1] != stable[1:]), strict=True))
        assert len(changes) > 6
        for row, column in changes:
            first, second = edge_map.axes[0][row : row + 2], edge_map.axes[1][column]
            assert any(meets(edge, first, second) for edge in edge_map.edges)


def meets(edge, span, second):
    """Whether an edge bounds stable orbits at `second`, with its first parameter in `span`."""
    a, b = edge.values.T
    for k in np.flatnonzero((b[:-1] - second) * (b[1:] - second) <= 0):
        share = (second - b[k]) / ((b[k + 1] - b[k]) or 1.0)
        if edge.bounding[k] and span[0] <= a[k] + share * (a[k + 1] - a[k]) <= span[1]:
            return True
    return False


def test_multipliers_on_the_edges(machine_map, paper_map):
    for edge in [*machine_map.edges, *paper_map.edges]:
        for orbit in edge.orbits[::5]:
            values = np.linalg.eigvals(orbit.root)
            assert orbit.converged
            if edge.kind in (FOLD, SYMMETRY):
                assert np.min(np.abs(values - (1 if edge.kind == FOLD else -1))) < 1e-6
            if edge.kind == TORUS:
                pair = values[np.abs(values.imag) > 0]
                assert np.min(np.abs(np.abs(pair) - 1)) < 1e-8


@pytest.mark.parametrize("kind", KINDS)
def test_derivatives_of_the_equations(kind, machine_orbit):
    """Exact derivatives of the equations are compared with central differences of order 8."""
    spans = np.array([[8.0, 44.0], [0.3, 0.95]])
    scale = np.max(np.abs(machine_orbit.state))
    problem = Problem(machine, kind, spans, scale, 1, machine_orbit.phase)
    values = np.array([machine_orbit.p[CLEARANCE], 0.7])
    x = problem.unknowns(machine_orbit.state, values)
    # The orbit has one turning point of Z2 in half a period, a contact. With 0 contacts it is the
    # next to become a contact.
    if kind == GRAZING:
        problem = replace(problem, contacts=0)
    rows = problem.rows(x, problem.path(x))
    for k in range(6):
        step, total = 1e-3, 0.0
        for number, weight in CENTRAL.items():
            for sign in (-1, 1):
                near = x + sign * number * step * np.eye(6)[k]
                total = total + sign * weight * problem.defects(near, problem.path(near)) / step
        assert_allclose(rows[:, k], total, atol=1e-7 * np.abs(total).max(), rtol=1e-7)


def edge_near_rigid(kind, oscillator, damper, frequency, ratio, restitutions):
    """Return a dict of the clearance on the edge at each restitution.

    The edge is sought near a motion between rigid walls. `ratio` is the speed of the loose mass
    between impacts divided by the clearance.
    """
    orbit = linear_orbit(oscillator, damper, frequency, ratio)
    clearance = orbit.p[CLEARANCE]

    def family(d0, e):
        return pack(oscillator, replace(damper, clearance=d0, restitution=e), frequency)

    spans = [(0.3 * clearance, 3 * clearance), restitutions]
    edge = follow_edge(family, kind, orbit, (clearance, damper.restitution), spans)
    return {e: at_end(edge, e) for e in restitutions}


def assert_limit(soft, stiff, rigid):
    """Check that walls four times as stiff halve the error, and that the limit is `rigid`."""
    assert_allclose((stiff - rigid) / (soft - rigid), 0.5, rtol=0.02)
    assert_allclose(2 * stiff - soft, rigid, rtol=2e-4)


@pytest.mark.parametrize("kind", [TORUS, SYMMETRY])
def test_limit_of_rigid_walls(kind):
    """For stiff walls edges converge to Masri and Caughey's boundaries for rigid walls.

    The error is inversely proportional to the square root of the stiffness.
    """
    restitutions = 0.6, 0.8

    def rigid(e):
        boundaries = stability_boundaries(MACHINE, replace(DAMPER, restitution=e), 1.0)
        return next(each.motion for each in boundaries if each.event == kind)

    ratio = rigid(0.7).speed / rigid(0.7).clearance
    soft, stiff = (
        edge_near_rigid(
            kind, MACHINE, replace(DAMPER, contact_stiffness=r1), 1.0, ratio, restitutions
        )
        for r1 in (2.5e4, 1e5)
    )
    for e in restitutions:
        assert_limit(soft[e], stiff[e], rigid(e).clearance)


def test_fold_in_the_limit_of_straight_flight():
    """Without a spring and with little damping a closed form exists for the fold.

    Between impacts the loose mass flies at constant speed, and only the forcing acts on the
    machine.
    """
    free, frequency, restitutions = Oscillator(1e-5, 0.0, cubic=0.0), 2.0, (0.5, 0.7)
    damper = Damper(0.2, 1.0, restitution=0.6)
    ratios = np.linspace(0.2, 2.0, 400)
    clearances = [flight_with_speed(free, damper, frequency, r).clearance for r in ratios]
    ratio = 0.95 * ratios[np.argmax(clearances)]
    soft, stiff = (
        edge_near_rigid(
            FOLD, free, replace(damper, contact_stiffness=r1), frequency, ratio, restitutions
        )
        for r1 in (2.5e4, 1e5)
    )
    for e in restitutions:
        # W^2 d0 at the fold does not depend on d0
        rigid = (straight_flight_end(free, 1.0, e) / frequency) ** 2
        assert_limit(soft[e], stiff[e], rigid)


def test_a_closed_edge(machine_orbit, machine_map):
    """If the clearance depends on a^2 + b^2 alone, the edge in the plane of a and b is a circle."""
    edge = edge_of(machine_map, SYMMETRY)
    place = np.argmin(np.abs(edge.values[:, 1] - 0.7))
    clearance = edge.values[place, 0]

    def round_family(a, b):
        return machine(clearance - 1.0 + a * a + b * b, edge.values[place, 1])

    spans = [(-2.0, 2.0), (-1.5, 2.5)]
    found = follow_edge(round_family, SYMMETRY, edge.orbits[place], (1.0, 0.0), spans)
    assert found.ends == ("closed", "closed")
    assert_allclose(np.hypot(*found.values.T), 1.0, atol=1e-8)
    turn = np.unwrap(np.arctan2(*found.values.T[::-1]))
    assert_allclose(abs(turn[-1] - turn[0]), 2 * np.pi, atol=1e-8)


def test_wrong_arguments_are_refused(machine_orbit):
    spans = [(8.0, 44.0), (0.3, 0.95)]
    values = machine_orbit.p[CLEARANCE], 0.7
    with pytest.raises(ValueError, match="kind = 'flip': must be one of fold"):
        follow_edge(machine, "flip", machine_orbit, values, spans)
    with pytest.raises(ValueError, match="must be symmetric"):
        follow_edge(machine, FOLD, replace(machine_orbit, root=None), values, spans)
    with pytest.raises(ValueError, match="must lie in"):
        follow_edge(machine, FOLD, machine_orbit, (1.0, 0.7), spans)
    with pytest.raises(ValueError, match="axes: must increase"):
        map_edges(machine, machine_orbit, values, ([8.0, 8.0], [0.3, 0.9]))
