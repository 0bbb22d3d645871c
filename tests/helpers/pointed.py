"""Kernels (functions compiled by numba) that take pointers, called with arrays."""

from functools import cache

import numba

from impact_damper.kernel.memory import pointer


@cache
def pointed(kernel):
    """Return a function of one or two arrays that calls a kernel with pointers to them."""

    @numba.njit
    def one(a):
        kernel(pointer(a))

    @numba.njit
    def two(a, d):
        kernel(pointer(a), pointer(d))

    return lambda *arrays: (one if len(arrays) == 1 else two)(*arrays)
