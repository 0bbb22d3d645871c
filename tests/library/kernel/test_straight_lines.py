"""`straight`, which compiles lines of arithmetic, against Python, and the errors that it raises."""

import numpy as np
import pytest
from helpers.pointed import pointed
from numpy.testing import assert_allclose

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.straight_lines import straight


def one_lane(a):
    for _ in range(1):
        x = a[0]
        y = -x / (a[1] - 0.5)
        a[2] = max(abs(y), x) * 2.0
        a[2] -= y


def sixteen_lanes(a):
    for i in range(16):
        x = a[0 + i]
        y = -x / (a[16 + i] - 0.5)
        a[32 + i] = max(abs(y), x) * 2.0
        a[32 + i] -= y


def four_columns(a, d):
    for i in range(4):
        d[4 + i] = a[1] * d[0 + i] + 1.0


def two_constants(a):
    for i in range(2):
        a[0 + i] = (3.0, -0.5)[i] * a[2] + a[0 + i]


def pair_of_one(a):
    for _ in range(1):
        x = a[0]
        pair = x * (a[1], x + 1.0) + (a[2], 0.0)
        first, last = pair - (x, 2.0) * pair
        a[3] = first / last
        a[4] = x * last - a[1]


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


one, two = straight(one_lane), straight(two_constants)
sixteen, four = straight(sixteen_lanes), straight(four_columns)
pair, pairs = straight(pair_of_one), straight(pairs_of_sixteen)


@kernel
def one_compiled(a):
    one(a)


@kernel
def sixteen_compiled(a):
    sixteen(a)


@kernel
def four_compiled(a, d):
    four(a, d)


@kernel
def two_compiled(a):
    two(a)


@kernel
def pair_compiled(a):
    pair(a)


@kernel
def pairs_compiled(a):
    pairs(a)


@pytest.mark.parametrize(
    ("compiled", "function", "sizes"),
    [
        (two_compiled, two_constants, [3]),
        (one_compiled, one_lane, [3]),
        (sixteen_compiled, sixteen_lanes, [48]),
        (four_compiled, four_columns, [2, 8]),
        (pair_compiled, without_pairs, [5]),
        (pairs_compiled, without_pairs, [80]),
    ],
)
def test_lines_do_what_python_does(compiled, function, sizes):
    random = np.random.default_rng(1995)
    given = [random.uniform(-1, 1, size) for size in sizes]
    expected = [array.copy() for array in given]
    function(*expected)
    pointed(compiled)(*given)
    for found, each in zip(given, expected, strict=True):
        assert_allclose(found, each, rtol=1e-15, atol=1e-15)


def test_a_kernel_with_an_unknown_line_does_not_compile():
    @straight
    def unknown(a):
        for _ in range(1):
            a[0] = min(a[0], 1.0)

    @kernel
    def calls_unknown(a):
        unknown(a)

    with pytest.raises(Exception, match=r"test_straight_lines\.py, line \d+: neither abs nor max"):
        pointed(calls_unknown)(np.zeros(1))
