"""Basins: against SciPy's integrator, the symmetry of the oscillator, and stable manifolds."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal
from scipy.integrate import solve_ivp
from scipy.spatial import cKDTree

from impact_damper.data.variables import BASIN_LABEL
from impact_damper.model.packed import pack
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions import ensemble
from impact_damper.motions.attractors import free_attractors
from impact_damper.motions.ensemble import label_states
from impact_damper.motions.steady import steady_motion
from impact_damper.orbits.basins import basins

CUBIC = Oscillator(0.215)
DUFFING = Oscillator(0.08, force=0.2)
PAPER = Damper(0.12, 2.0)
WINDOW = np.array([3.0, 4.5])
FREQUENCIES = (1.6, 1.85)


def slope(frequency, states, oscillator):
    """Return the free equation of motion of many states at once, for `solve_ivp`."""
    count = len(states)

    def rate(t, y):
        x, v = y[:count], y[count:]
        force = oscillator.force * np.cos(frequency * t)
        return np.concatenate([v, force - oscillator.damping * v - x**3])

    return rate


def run(frequency, states, begin, end, oscillator=CUBIC):
    """Return states after a time, by DOP853."""
    start = np.asarray(states).T.ravel()
    found = solve_ivp(
        slope(frequency, states, oscillator), (begin, end), start, "DOP853", rtol=1e-10, atol=1e-11
    )
    return found.y[:, -1].reshape(2, -1).T


@pytest.fixture(scope="module", params=FREQUENCIES)
def free(request):
    """Return frequency, packed parameters and attractors of the free oscillator."""
    p = pack(CUBIC, None, request.param)
    return request.param, p, free_attractors(p, WINDOW, Settling())


@pytest.mark.thorough
def test_labels_of_random_states(free):
    """SciPy's runs over 60 periods end on the attractors that the labels name."""
    frequency, p, attractors = free
    states = np.random.default_rng(7).uniform(-WINDOW, WINDOW, (100, 2))
    phase = 1.0
    labels, _ = label_states(p, states, phase, attractors, 1e-9, 1500)
    assert np.all(labels >= 0)
    begin = phase / frequency
    strobe = np.pi / 2 / frequency
    ends = run(frequency, states, begin, strobe + 60 * 2 * np.pi / frequency)
    distance, nearest = cKDTree(attractors.centre).query(ends)
    assert_array_equal(attractors.owner[nearest], labels)
    assert np.max(distance) < 1e-4


def test_neighbourhoods_contract(free):
    """States on the boundary of a proven neighbourhood come closer to the orbit within a period."""
    frequency, _, attractors = free
    assert np.all(np.isfinite(attractors.shape))
    angles = np.linspace(0, 2 * np.pi, 16, endpoint=False)
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    period = 2 * np.pi / frequency
    for owner, centre, shape in zip(*attractors[1:], strict=True):
        edge = centre + circle @ np.linalg.inv(shape).T
        n = int(attractors.records["period"][owner])
        strobe = np.pi / 2 / frequency
        after = run(frequency, edge, strobe, strobe + n * period) - centre
        assert np.max(np.linalg.norm(after @ shape.T, axis=1)) < 1
        # The neighbourhood is not needlessly small: a run lasts until it enters the neighbourhood.
        assert np.sqrt(abs(np.linalg.det(shape))) < 300


def changes(data):
    """Return, in cell widths, the middles between neighbouring states with different labels."""
    label = data["basin_label"].values
    rows, columns = np.indices(label.shape)
    found = []
    for axis in (0, 1):
        low, high = (label[:-1], label[1:]) if axis == 0 else (label[:, :-1], label[:, 1:])
        where = np.nonzero(low != high)
        middle = np.stack([columns[where], rows[where]], axis=1).astype(float)
        middle[:, 1 - axis] += 0.5
        found.append(middle)
    return np.concatenate(found)


def in_cells(data, x, v):
    """Return states as places in a plane, in cell widths."""
    axes = [data[f"basin_{name}"].values for name in ("displacement", "velocity")]
    return np.stack(
        [
            (values - axis[0]) / (axis[1] - axis[0])
            for values, axis in zip((x, v), axes, strict=True)
        ],
        axis=1,
    )


@pytest.mark.thorough
def test_boundaries_are_stable_manifolds():
    """The label of the resonance changes within a cell of a stable manifold, and all along it.

    The manifold belongs to the unstable orbit of period 1 and is a simple curve. Windings of the
    manifold of period 3 are closer to each other than a cell.
    """
    wide = basins(CUBIC, None, 1.85, cells=120, phase=3.0)
    first = wide["boundary_saddle"].values == int(np.argmin(wide["saddle_period"].values))
    x, v = wide["boundary_displacement"].values[first], wide["boundary_velocity"].values[first]
    kept = np.isfinite(x)
    first_curve = in_cells(wide, x[kept], v[kept])
    resonance = wide["basin_label"] == int(np.argmax(wide["attractor_displacement"].values))
    distance, _ = cKDTree(first_curve).query(changes(wide.assign(basin_label=resonance)))
    assert np.max(distance) < 1

    distance, _ = cKDTree(changes(wide)).query(first_curve)
    inside = (np.abs(x[kept]) < wide["basin_displacement"].values[-1]) & (
        np.abs(v[kept]) < wide["basin_velocity"].values[-1]
    )
    assert inside.sum() > 500 and np.max(distance[inside]) < 1


def test_a_softening_spring_lets_motions_escape():
    soft = Oscillator(0.1, 1.0, -0.2, 0.1)
    data = basins(soft, None, 0.8, displacement=4, velocity=4, cells=40)
    assert np.any(data["basin_label"] == BASIN_LABEL["escaped"])
    assert float(data["attractor_share"].sum()) > 0


def test_a_plane_with_the_damper_its_mirror_image_and_a_part_of_it():
    """(Z, T) -> (-Z, T + half a period) maps basins onto each other."""
    plane = {"displacement": 0.3, "velocity": 0.4, "cells": 4}
    box = {"displacement": (-0.3, -0.1), "velocity": (0.4 / 3, 0.4), "cells": 2}
    one = basins(CUBIC, PAPER, 2.0, loose=(1.0, -0.2), phase=1.0, **plane)
    two = basins(CUBIC, PAPER, 2.0, loose=(-1.0, 0.2), phase=1.0 + np.pi, **plane)
    part = basins(CUBIC, PAPER, 2.0, loose=(1.0, -0.2), phase=1.0, **box)
    sizes = [
        np.append(data["attractor_displacement"].values, np.nan)[
            np.maximum(data["basin_label"].values, -1)
        ]
        for data in (one, two, part)
    ]
    assert_allclose(sizes[0], sizes[1][::-1, ::-1], rtol=1e-4)
    assert_allclose(sizes[0][2:, :2], sizes[2], rtol=1e-9)
    with pytest.raises(ValueError, match="displacement = .*least and greatest"):
        basins(CUBIC, PAPER, 2.0, displacement=(0.1, -0.1))


@pytest.fixture(scope="module")
def duffing():
    """Return the basins of the Duffing oscillator in the documentation of pybasin.

    x'' + 0.08 x' + x^3 = 0.2 cos t from states in [-1, 1] x [-0.5, 1] has five attractors.
    """
    box = {"displacement": (-1, 1), "velocity": (-0.5, 1), "phase": 0.0}
    return basins(DUFFING, None, 1.0, **box, cells=150, shock=0.05, within=15)


@pytest.mark.thorough
def test_shares_are_those_of_pybasin(duffing):
    """10000 random starts of pybasin give the shares 0.2023, 0.2482, 0.0288, 0.0257 and 0.495."""
    assert_array_equal(duffing.attractor_period, [1, 3, 2, 2, 1])
    found = duffing.attractor_share.values
    known = np.array([0.2023, 0.2482, 0.0288 + 0.0257, 0.495])
    found = np.array([*found[:2], found[2] + found[3], found[4]])  # two mirror images have one size
    assert np.all(np.abs(found - known) < 4 * np.sqrt(known * (1 - known) / 1e4))


def after(states, cycles, begin=0.0):
    """Return the states of the Duffing oscillator `cycles` after the time `begin`, by DOP853."""
    return run(1.0, states, begin, begin + 2 * np.pi * cycles, DUFFING)


@pytest.mark.thorough
def test_the_minimal_critical_shock_is_that_of_scipy(duffing):
    """All smaller impulses, to either side, lead back to the small motion."""
    point = np.array([duffing.attractor_point[0, 0], duffing.attractor_speed[0, 0]])
    least = float(duffing.attractor_shock[0])
    assert least == pytest.approx(0.0516, rel=1e-2)
    sizes = least * np.array([*np.linspace(0.05, 0.95, 30), 1 - 1e-4, 1 + 1e-4])
    pushed = point + np.outer([*sizes, *-sizes], (0, 1))
    away = np.linalg.norm(after(pushed, 100) - point, axis=1) > 0.1
    assert not away[:31].any() and not away[32:63].any() and (away[31] or away[63])
    assert np.isfinite(duffing.attractor_return[0]) and np.isinf(duffing.attractor_return[2])


@pytest.mark.thorough
def test_convergence_times_are_those_of_scipy(duffing):
    """A time is the number of cycles until a motion lies in a proven neighbourhood of its orbit."""
    attractors = free_attractors(pack(DUFFING, None, 1.0), np.array([1.5, 1.5]), Settling())
    x, v = (duffing[f"basin_{name}"].values for name in ("displacement", "velocity"))
    rows, columns = np.random.default_rng(3).integers(0, 150, (2, 40))
    states = run(1.0, np.stack([x[columns], v[rows]], axis=1), 0.0, np.pi / 2, DUFFING)
    times = np.full(40, -1)
    for cycle in range(60):
        offset = states[:, None] - attractors.centre
        size = np.linalg.norm(np.einsum("kij,nkj->nki", attractors.shape, offset), axis=2)
        times = np.where((times < 0) & np.any(size < 1, axis=1), cycle, times)
        states = after(states, 1, np.pi / 2)
    assert_array_equal(duffing.basin_time.values[rows, columns], times)
    share = np.mean((duffing.basin_label == 4) & (duffing.basin_time <= 15))
    assert duffing.attractor_within[4] == share and 0 < share < duffing.attractor_share[4]


@pytest.mark.thorough
def test_shocks_with_the_damper_lead_back_or_away():
    """Impulses below the minimal critical shock lead back; chaos decides about larger impulses."""
    data = basins(CUBIC, PAPER, 1.7, cells=3, loose=(0.5, 0.0), displacement=1.0, velocity=5.0)
    least, size = float(data.attractor_shock[0]), float(data.attractor_displacement[0])
    assert 0 < least < 5
    quiet, moved = steady_motion(CUBIC, PAPER, 1.7, (0.006, 0.187, 0.002, -2.408)), []
    for factor in np.outer((0.5, 0.999, 1.001, 1.003, 1.02, 1.05), (1, -1)).ravel():
        state = quiet["state"] + factor * least * np.array([0, 1, 0, 1])
        moved.append(float(steady_motion(CUBIC, PAPER, 1.7, state)["maximum_displacement"]))
    back = np.isclose(moved, size, rtol=1e-5)
    assert back[:4].all() and not back[4:].all()


def test_the_numbers_of_labels_stand_in_the_registry():
    """Kernels may not import the registry of variables, and repeat two numbers of the registry."""
    assert ensemble.GONE == BASIN_LABEL["escaped"]
    assert ensemble.UNKNOWN == BASIN_LABEL["unresolved"]
