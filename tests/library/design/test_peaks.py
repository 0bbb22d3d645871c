"""Peaks between the frequencies of a grid: closed form, and a grid a hundred times as fine."""

import math

import numpy as np
from numpy.testing import assert_allclose

from impact_damper.design.absorber_problems import problems_of
from impact_damper.design.absorber_search import search
from impact_damper.design.linear_response import linear_machine, maxima, tuning_of
from impact_damper.design.peaks import linear_peak, orbit_peaks
from impact_damper.design.tuning import den_hartog_absorber, exact_absorber
from impact_damper.model.machine import Machine

SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.005, "force": 40}
GRID, SHARES = np.linspace(16.0, 26.0, 9), np.array([0.5, 1.0])


def test_linear_peaks_are_the_closed_ones():
    machine = Machine(**SPRING)
    assert_allclose(linear_peak(machine, None, GRID)[1], 2e-4 / 0.01, rtol=1e-4)
    absorber, linear = den_hartog_absorber(machine, 0.6), linear_machine(machine)
    highest = maxima(linear, tuning_of(machine, absorber), (0.0, math.inf))[1].max()
    _, height = linear_peak(machine, absorber, GRID)
    assert_allclose(height, linear.unit * np.sqrt(highest), rtol=1e-9)


def test_peaks_of_orbits_are_those_of_a_fine_grid():
    machine = Machine(**SPRING, cubic_stiffness=1e9)
    absorber = exact_absorber(machine, 0.6)

    def searched(frequencies):
        problems = problems_of(machine, absorber, frequencies, SHARES)
        return search(problems, (len(frequencies), len(SHARES)), 1, 1)[:2]

    _, heights = orbit_peaks(machine, absorber, GRID, SHARES, searched(GRID)[1])
    fine = searched(np.linspace(16.0, 26.0, 801))[0]
    assert_allclose(heights, fine.most.reshape(-1, len(SHARES)).max(axis=0), rtol=1e-4)


def test_a_peak_at_a_fold():
    """The peak of a hardening machine without an absorber is the last orbit before the fold."""
    machine = Machine(**SPRING, cubic_stiffness=4e9)
    frequencies = np.array([20.0, 25.0, 30.0, 40.0])
    problems = problems_of(machine, None, frequencies, [1.0])
    orbits = search(problems, (4, 1), 1, 1)[1]
    frequency, height = orbit_peaks(machine, None, frequencies, np.ones(1), orbits)
    size = height[0] * machine.scales.length
    # at the peak the dashpot alone balances the force, and the spring the inertia
    w = 2 * np.pi * frequency[0]
    assert_allclose(40 / (machine.viscous_damping * w), size, rtol=0.03)
    assert_allclose(12 * w**2, 2e5 + 0.75 * 4e9 * size**2, rtol=0.03)
