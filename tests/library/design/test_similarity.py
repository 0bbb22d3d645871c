"""A machine scaled in mass, time and length has the scaled design: the law of similarity.

Powers of two scale a linear machine exactly in binary arithmetic, so that the same starts lead to
the same motions, chaotic ones too.
"""

import numpy as np
import pytest
from helpers import design_tasks

import impact_damper as idm
from impact_damper.design.promise import Promise
from impact_damper.design.task import NOMINAL

# Dimensions of the values of a machine: powers of mass, length and time.
DIMENSIONS = {
    "mass": (1, 0, 0),
    "linear_stiffness": (1, 0, -2),
    "cubic_stiffness": (1, -2, -2),
    "damping_ratio": (0, 0, 0),
    "force": (1, 1, -2),
    "unbalance": (1, 1, 0),
    "base_displacement": (0, 1, 0),
}
SPRING = {"mass": 12, "linear_stiffness": 2e5, "damping_ratio": 0.01}
MACHINES = {
    "force": SPRING | {"cubic_stiffness": 4e9, "force": 40},
    "unbalance": SPRING | {"cubic_stiffness": 1e9, "unbalance": 0.002},
    "base": SPRING | {"base_displacement": 2e-4},
}
BANDS = {"force": (26, 34), "unbalance": (22, 24), "base": (20.4, 20.7)}
# Factors of mass, length and time. BOARD leads to a circuit board, TON to a machine of more than a
# ton. The factors in ANY are not powers of two.
BOARD, TON, ANY = (2.0**-5, 2.0**-3, 2.0**-2), (2.0**7, 2.0, 2.0**2), (0.3, 0.7, 1.9)


def task(name, factors=(1, 1, 1)):
    """Return the task for a machine whose mass, lengths and times are multiplied by factors."""

    def scaled(value, powers):
        return float(value * np.prod(np.array(factors) ** np.array(powers, float)))

    values = {key: scaled(value, DIMENSIONS[key]) for key, value in MACHINES[name].items()}
    return design_tasks.task(
        machine=idm.Machine(**values),
        mass=scaled(0.6, (1, 0, 0)),
        band=[scaled(end, (0, 0, -1)) for end in BANDS[name]],
        restitution=0.7,
        contact=scaled(2e7, (1, 0, -2)),
        frequencies=3,
        candidates=4,
        starts=16,
        share=0.8,
    )


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("factors", [BOARD, TON, ANY])
def test_the_dimensionless_problem_is_the_same(name, factors):
    one, other = task(name), task(name, factors)
    gap = one.rule_gap(one.worst_frequency)
    np.testing.assert_allclose(other.grid * factors[2], one.grid, rtol=1e-12)
    for f in one.grid:
        expected = one.packed(gap, f)
        found = other.packed(gap * factors[1], f / factors[2])
        np.testing.assert_allclose(found, expected, rtol=1e-12)
    np.testing.assert_allclose(other.rule_gap(one.worst_frequency / factors[2]), factors[1] * gap)


def test_the_same_starts_have_the_same_bounds():
    """All numbers are equal to the last bit."""
    one, other = task("base"), task("base", TON)
    gap = 0.8e3 * one.rule_gap(20.5)
    sizes = [
        Promise(each, 1e-3 * scale * gap, [NOMINAL], ("search",)).bounds
        for each, scale in ((one, 1.0), (other, TON[1]))
    ]
    np.testing.assert_array_equal(sizes[1], TON[1] * sizes[0])


def test_the_gaps_of_a_search_scale():
    one, other = task("force"), task("force", ANY)
    np.testing.assert_allclose(other.gap_span, np.multiply(ANY[1], one.gap_span), rtol=1e-9)
