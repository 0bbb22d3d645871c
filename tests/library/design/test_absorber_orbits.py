"""Orbits of a machine with an absorber: SciPy, Liouville's formula, the balance of energy."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.integrate import solve_ivp

from impact_damper.design.absorber_orbits import find_orbits
from impact_damper.design.absorber_problems import problems_of
from impact_damper.design.absorber_seeds import harmonic_seeds
from impact_damper.design.smooth_runs import DAMPING, INVERSE_MASS, LINK_DAMPING
from impact_damper.design.tuning import nonlinear_absorber
from impact_damper.model.machine import Machine

HARD = Machine(mass=12, linear_stiffness=2e5, cubic_stiffness=4e9, damping_ratio=0.005, force=40)
ABSORBER = nonlinear_absorber(HARD, 0.6)
FREQUENCIES, SHARES = [9.0, 21.0, 24.0], [0.5, 1.0, 2.0]


@pytest.fixture(scope="module", params=[None, ABSORBER], ids=["bare", "nonlinear"])
def found(request):
    problems = problems_of(HARD, request.param, FREQUENCIES, SHARES)
    orbits = find_orbits(problems, *harmonic_seeds(problems))
    return request.param, problems, orbits.take(orbits.converged).distinct()


def equation(absorber, hertz, share):
    """Return the function of the rates, in SI units, of state, work of the force, and losses.

    The losses are those in the dashpots of machine and absorber.
    """

    def rate(t, y):
        x, v, u, w = y[:4]
        force = 40 * share * np.cos(2 * np.pi * hertz * t)
        total = force - HARD.viscous_damping * v - 2e5 * x - 4e9 * x**3
        lost, link = HARD.viscous_damping * v**2, 0.0
        if absorber is None:
            return [v, total / 12, v, total / 12, force * v, lost]
        link = absorber.stiffness * u + absorber.damping * w + absorber.cubic_stiffness * u**3
        lost += absorber.damping * w**2
        acceleration = (total - link) / 12
        return [v, acceleration, w, acceleration - link / absorber.mass, force * v, lost]

    return rate


def test_orbits_by_scipy(found):
    """By SciPy orbits close, are symmetric, and balance their energy; displacements agree."""
    absorber, _, orbits = found
    unit = [HARD.scales.length, np.nan, HARD.scales.length, np.nan]
    for problem, state, sizes in zip(orbits.problem, orbits.state, orbits.largest, strict=True):
        hertz, share = FREQUENCIES[problem // 3], SHARES[problem % 3]
        unit[1] = unit[3] = HARD.scales.length * 2 * np.pi * hertz
        start = state * unit
        run = solve_ivp(
            equation(absorber, hertz, share),
            (0, 1 / hertz),
            [*start, 0, 0],
            method="DOP853",
            rtol=1e-12,
            atol=1e-16,
            t_eval=np.linspace(0, 1 / hertz, 20001),
        ).y
        sizes = sizes * unit
        assert_allclose(run[:4, -1] / sizes, start / sizes, atol=1e-7)
        assert_allclose(run[:4, 10000] / sizes, -start / sizes, atol=1e-7)
        assert_allclose(np.abs(run[::2, :].T[:, :2]).max(axis=0), sizes[::2], rtol=1e-7)
        assert_allclose(run[4, -1], run[5, -1], rtol=1e-6)


def test_multipliers_follow_liouville(found):
    absorber, problems, orbits = found
    some = problems[orbits.problem]
    trace = some[:, DAMPING] + some[:, LINK_DAMPING] * (1 + some[:, INVERSE_MASS])
    active = 2 if absorber is None else 4
    product = np.prod(orbits.multipliers[:, :active], axis=1)
    assert_allclose(product, np.exp(-2 * np.pi * trace), rtol=1e-7)


def test_the_bare_machine_has_three_motions_between_its_folds(found):
    absorber, _, orbits = found
    total = np.bincount(orbits.problem, minlength=9).reshape(3, 3)
    stable = np.bincount(orbits.problem[orbits.stable], minlength=9).reshape(3, 3)
    folded = [[1, 1, 1], [1, 1, 1], [3, 3, 3]]
    np.testing.assert_array_equal(total, folded if absorber is None else np.ones((3, 3)))
    np.testing.assert_array_equal(stable, np.minimum(total, 2))
