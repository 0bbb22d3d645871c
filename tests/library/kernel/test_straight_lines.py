"""`straight`, which compiles lines of arithmetic, gives Python's results or raises an error."""

import numpy as np
import pytest
from helpers.pointed import pointed
from numpy.testing import assert_allclose

from impact_damper.kernel.branches import template
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.straight_lines import straight


def sixteen_lanes(a):
    for i in range(16):
        x = a[0 + i]
        y = -x / (a[16 + i] - 0.5)
        a[32 + i] = max(abs(y), x) * 2.0
        a[32 + i] -= y


def pairs_of_sixteen(a):
    for i in range(16):
        x = a[0 + i]
        pair = x * (a[16 + i], x + 1.0) + (a[32 + i], 0.0)
        first, last = pair - (x, 2.0) * pair
        a[48 + i] = first / last
        a[64 + i] = x * last - a[16 + i]


def without_pairs(a):
    x, y, z = a[: 3 * len(a) // 5].reshape(3, -1)
    first, last = x * y + z, x * (x + 1.0)
    first, last = first - x * first, last - 2.0 * last
    a[3 * len(a) // 5 :] = [*(first / last), *(x * last - y)]


sixteen, pairs = (template(straight(each), each) for each in (sixteen_lanes, pairs_of_sixteen))


@kernel
def compiled(a, d):
    sixteen(a)
    pairs(d)


def test_lines_do_what_python_does():
    random = np.random.default_rng(1995)
    given = [random.uniform(-1, 1, size) for size in (48, 80)]
    expected = [array.copy() for array in given]
    sixteen_lanes(expected[0])
    without_pairs(expected[1])
    pointed(compiled)(*given)
    for found, each in zip(given, expected, strict=True):
        assert_allclose(found, each, rtol=1e-15, atol=1e-15)


def test_a_kernel_with_an_unknown_line_does_not_compile():
    @straight
    def unknown(a):
        for _ in range(1):
            a[0] = min(a[0], 1.0)

    called = template(unknown, unknown)

    @kernel
    def calls_unknown(a):
        called(a)

    with pytest.raises(Exception, match=r"test_straight_lines\.py, line \d+: unknown"):
        pointed(calls_unknown)(np.zeros(1))
