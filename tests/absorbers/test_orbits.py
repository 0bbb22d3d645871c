"""Orbits of a machine with an absorber, against SciPy and Liouville's formula."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from impact_damper.absorbers.motions import stable_motions
from impact_damper.absorbers.problems import problems_of
from impact_damper.absorbers.tuning import nonlinear_absorber
from impact_damper.machine.machine import Machine

HARD = Machine(mass=12, linear_stiffness=2e5, cubic_stiffness=4e9, damping_ratio=0.005, force=40)
ABSORBER = nonlinear_absorber(HARD, 0.6)
FREQUENCIES, SHARES = [18.0, 21.0, 24.0], [0.5, 1.0, 2.0]


@pytest.fixture(scope="module", params=[None, ABSORBER], ids=["bare", "nonlinear"])
def found(request):
    problems = problems_of(HARD, request.param, FREQUENCIES, SHARES)
    return request.param, problems, stable_motions(problems)


def newton(absorber, hertz, share):
    """Return the equation of motion in SI units; states as in `problems`."""

    def rate(t, y):
        x, v = y[:2]
        force = 40 * share * np.cos(2 * np.pi * hertz * t)
        total = force - HARD.viscous_damping * v - 2e5 * x - 4e9 * x**3
        if absorber is None:
            return [v, total / 12]
        u, w = y[2:]
        link = absorber.stiffness * u + absorber.damping * w + absorber.cubic_stiffness * u**3
        return [v, (total - link) / 12, w, (total - link) / 12 - link / absorber.mass]

    return rate


def test_orbits_close_in_si_units_by_scipy(found):
    absorber, problems, motions = found
    scales = HARD.scales
    length, speed = scales.unit("displacement"), scales.unit("velocity")
    for place, index in enumerate(motions.index):
        hertz, share = FREQUENCIES[index // 3], SHARES[index % 3]
        start = motions.orbits.state[:, place] * [length, speed, length, speed][: problems.size]
        run = solve_ivp(
            newton(absorber, hertz, share),
            (0, 1 / hertz),
            start,
            method="DOP853",
            rtol=1e-12,
            atol=1e-16,
            t_eval=np.linspace(0, 1 / hertz, 20001),
        )
        assert_allclose(run.y[:, -1], start, atol=1e-7 * np.abs(start).max())
        size = motions.orbits.displacement[place] * length
        assert_allclose(np.abs(run.y[0]).max(), size, rtol=1e-7)


def test_multipliers_follow_liouville(found):
    _, problems, motions = found
    some = problems.take(motions.index)
    trace = some.damping.copy()
    if some.link is not None:
        mass, _, damping, _ = some.link
        trace += damping * (1 + 1 / mass)
    product = np.prod(motions.orbits.multipliers, axis=1)
    assert_allclose(product, np.exp(-trace * 2 * np.pi / some.frequency), rtol=1e-7)


def test_the_bare_machine_has_two_motions_between_its_folds(found):
    absorber, _, motions = found
    counts = np.bincount(motions.index, minlength=9).reshape(3, 3)
    expected = [[1, 1, 1], [1, 1, 1], [2, 2, 2]] if absorber is None else np.ones((3, 3))
    np.testing.assert_array_equal(counts, expected)
