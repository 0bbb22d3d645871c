"""`template`, which compiles functions with branches, against Python."""

import math

import numpy as np
import pytest
from helpers.pointed import pointed

from impact_damper.kernel.branches import bits, number, template
from impact_damper.kernel.compiling import kernel

LANES, ROWS = 4, (8, 12)
EXCLUDED = False


def first_above(a, i, limit, least=0.25):
    """Return two numbers, by an early return or by the last line."""
    limit = max(limit, least)
    if not a[i] < limit:
        return a[i], True
    return -a[i] + a[i] * a[i] / 3.0, False


def count_turns(a, i, angle):
    turns = 0
    while abs(angle) > math.pi and turns < 5:
        angle -= 2.0 * math.pi if angle > 0.0 else -2.0 * math.pi
        turns += 1
    a[4 + i] = turns + math.sin(angle) * np.floor(3.0 * a[i])


def work(a):
    found = 0
    for i in range(LANES):
        x, above = first_above(a, i, 0.5 if i % 2 == 0 else 0.1)
        found += 1 if above and 0.0 < x <= 9.0 or x == -1.0 else 0
        count_turns(a, i, 20.0 * a[i])
        for k in range(len(ROWS)):
            a[ROWS[k] + i] = min(x, 1.0, a[4 + i]) if k else number(bits(abs(x)) >> 1)
    a[16] = found
    if EXCLUDED:
        a[1000] = missing  # noqa: F821


compiled_work = template(work, work)


@kernel
def calls_work(a):
    compiled_work(a)


def test_branches_do_what_python_does():
    a = np.zeros(17)
    a[:LANES] = 0.7, -0.3, 0.2, 1.1
    expected = a.copy()
    work(expected)
    pointed(calls_work)(a)
    np.testing.assert_allclose(a, expected, rtol=1e-13, atol=1e-300)


def test_an_unknown_statement_is_named():
    def unknown(a):
        del a

    called = template(unknown, unknown)

    @kernel
    def calls_unknown(a):
        called(a)

    with pytest.raises(
        Exception, match=r"test_branches\.py, line \d+: unknown in templates: del a"
    ):
        pointed(calls_unknown)(np.zeros(1))
