"""Starts of searches are scaled by the free motions; a narrow ball of starts misses motions."""

import json
import math
import warnings

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, PAPER
from numpy.testing import assert_allclose
from references.equation import KNOWN, SPRINGS
from scipy import stats
from scipy.integrate import solve_ivp

import impact_damper as idm
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.model.settling import Settling
from impact_damper.motions.response import frequency_response
from impact_damper.motions.start_states import (
    free_motions,
    missed_share,
    search_starts,
    warn_if_narrow,
)

SETTLING = Settling()


def hardening_machine():
    """Return a machine's oscillator, damper and frequency, and the unit of length in mm."""
    mass, stiffness, cubic, force = 12.0, 2e5, 4e9, 40.0  # kg, N/m, N/m^3, N
    length = (force / cubic) ** (1 / 3)
    rate = math.sqrt(cubic * length**2 / mass)
    natural = math.sqrt(stiffness / mass) / rate
    oscillator = Oscillator(2 * 0.005 * natural, natural)
    damper = Damper(0.05, 3e-3 / (2 * length), 0.8)
    return oscillator, damper, 2 * math.pi * 30 / rate, 1e3 * length


def test_the_default_search_finds_the_violent_motion_that_a_ball_of_radius_2_misses():
    oscillator, damper, frequency, unit = hardening_machine()
    wide = frequency_response(oscillator, damper, [frequency])
    expected = r"radius = 2: smaller than the free motion at .* = 19.47"
    with pytest.warns(UserWarning, match=expected) as told:
        narrow = frequency_response(oscillator, damper, [frequency], radius=2.0)
    assert told[0].filename == __file__  # the caller's line, not a line of the library
    largest = {
        name: unit * np.nanmax(data.maximum_displacement)
        for name, data in (("wide", wide), ("narrow", narrow))
    }
    assert largest["narrow"] < 1 and 9.2 < largest["wide"] < 9.5
    assert narrow.start_displacement == narrow.start_speed == 2
    assert narrow.free_speed > 2
    assert wide.start_displacement > wide.free_displacement > 4
    assert wide.missed_share == 3 / 96
    assert "radius" not in wide.attrs and wide.motion_starts.sum() == 96


@pytest.mark.parametrize("name, frequency", [("softening", 0.85), ("linear", 1.3), ("shaken", 1.0)])
def test_free_motions_are_settled_ones(name, frequency):
    """In SciPy each free motion returns after a cycle; largest displacement and speed agree."""
    oscillator = SPRINGS[name]
    found = free_motions(oscillator, frequency, SETTLING)
    force = oscillator.forcing_amplitude(frequency)

    def rates(time, y):
        spring = oscillator.linear_frequency**2 * y[0] + oscillator.cubic * y[0] ** 3
        return y[1], force * np.cos(frequency * time) - oscillator.damping * y[1] - spring

    largest = []
    for state in found.states:
        span = 0, 2 * math.pi / frequency
        run = solve_ivp(rates, span, state, "DOP853", rtol=1e-11, atol=1e-12, max_step=0.01)
        largest.append(np.max(np.abs(run.y), axis=1))
        assert_allclose(run.y[:, -1], state, atol=1e-6)
    assert_allclose(np.max(largest, axis=0), [found.displacement, found.speed], rtol=1e-3)
    assert len(found.states) == (2 if name == "softening" else 1)


@pytest.mark.parametrize("name", KNOWN)
def test_random_starts_lie_within_what_the_search_states(name):
    oscillator, damper = SPRINGS[name], Damper(0.1, 0.7)
    search = search_starts(oscillator, [(damper, 1.1)], 2000, None, 3, SETTLING)
    states, most = search.random[0], (search.displacement[0], search.speed[0])
    assert np.all(np.abs(states[:, 2]) < 0.7)
    assert np.all(np.abs(states[:, :2]) <= most)
    assert np.all(np.max(np.abs(states[:, :2]), axis=0) > 0.9 * np.array(most))
    if oscillator.cubic < 0:
        barrier = oscillator.linear_frequency / math.sqrt(-oscillator.cubic)
        assert search.displacement[0] <= barrier
    else:
        assert search.displacement[0] > search.free_displacement[0]
        assert search.speed[0] > search.free_speed[0]


def test_a_radius_gives_the_ball_and_warns_only_where_it_is_narrow():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        search = search_starts(PAPER, [(DESIGN, 2.3)] * 2, 8, 2.0, 1, SETTLING)
    assert np.all(np.linalg.norm(search.random, axis=2) <= 2)
    assert [len(each) for each in search.placed] == [0, 0]
    with pytest.warns(
        UserWarning, match="radius = 2: .* frequency = 2, .* = 2.31.* and speed = 4.6"
    ):
        warn_if_narrow(PAPER, [1.0, 2.0, 2.3], 2.0)


def test_the_loose_mass_anywhere_in_its_gap_beside_a_machine_in_a_disk_or_at_rest():
    """With `whole_gap` a small radius does not warn, and the radius may be 0."""
    wide = Damper(0.12, 5.0)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        search = search_starts(PAPER, [(wide, 2.0)], 2000, 0.5, 1, SETTLING, whole_gap=True)
    states = search.random[0]
    assert stats.kstest((states[:, 0] ** 2 + states[:, 1] ** 2) / 0.25, "uniform").pvalue > 0.01
    assert stats.kstest(states[:, 2] / 10 + 0.5, "uniform").pvalue > 0.01
    assert not states[:, 3].any()
    machine = idm.Machine(mass=12, linear_stiffness=2e5, damping_ratio=0.02, force=40)
    damper = machine.damper(mass=0.6, gap=2e-3, restitution=0.7, contact_stiffness=2e6)
    given = {"radius": 0.0, "whole_gap": True, "starts": 40}
    found = idm.frequency_response(machine, damper, [20.5], **given)
    assert found.start_displacement == 0 and found.motion_starts.sum() == 40
    named = {"mass_ratio": 0.05, "restitution": 0.7, "contact_stiffness": 300.0}
    sweep = idm.clearance_sweep(Oscillator(0.215), named, 2.0, [1.5, 2.0], **given)
    assert json.loads(sweep.attrs["parameters"])["whole_gap"]
    with pytest.raises(ValueError, match="radius"):
        idm.frequency_response(machine, damper, [20.5], whole_gap=True)
    with pytest.raises(ValueError, match="radius"):
        idm.frequency_response(machine, damper, [20.5], radius=0.0)


def test_bound_on_what_was_never_seen():
    """All n starts miss a motion of the share `missed_share(n)` with just below 5 % probability."""
    for n in (24, 96, 1000):
        assert (1 - missed_share(n)) ** n < 0.05 < (1 - 0.9 * missed_share(n)) ** n * 1.1
    assert missed_share(0) == missed_share(1) == 1
