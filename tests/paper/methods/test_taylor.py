"""Contacts and peaks from the steps of the Taylor series, compared with `motions.records`."""

import math

import numpy as np
import pytest
from helpers.known_orbits import DESIGN, INELASTIC, PAPER
from numpy.testing import assert_allclose

from chatterjee1995.methods.integrators import taylor
from impact_damper.model.packed import pack
from impact_damper.motions import records, traces
from impact_damper.motions.strobe_map import strobe_time

PERIODS = 20
START = np.array([0.9, -0.4, 0.3, 1.1])
cases = pytest.mark.parametrize("damper", [None, DESIGN, INELASTIC])


def run(damper, start=START):
    p = pack(PAPER, damper, 2.0)
    return p, taylor.taylor(p, start, strobe_time(p), PERIODS, 1e-11)


@cases
def test_a_run_agrees_with_the_records_of_the_motion(damper):
    p, found = run(damper)
    begin = strobe_time(p)
    states, log = traces.trace(p, START, begin, [begin, begin + PERIODS * math.pi], 1e-11)
    assert_allclose(found.state, states[-1], atol=1e-13)
    assert_allclose(found.contact_times, log[:, 1], atol=1e-13)
    largest = records.measured(p, START, PERIODS, 1e-11)["maximum_displacement"]
    assert found.displacement == pytest.approx(largest, rel=1e-8)
    assert (np.diff(found.peak_times) > 0).all()
    assert found.displacement == found.peaks.max()


def test_a_contact_at_the_start_counts_and_a_run_that_overflows_fails():
    p, found = run(DESIGN, np.array([0.1, 0.0, 2.01, 0.5]))
    assert found.contact_times[0] == strobe_time(p)
    _, lost = run(DESIGN, np.array([1e200, 0.0, 0.0, 1.0]))
    assert lost.status == "failed" and np.isnan(lost.displacement)
