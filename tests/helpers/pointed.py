"""Kernels (functions compiled by numba) that take pointers, called with arrays."""

import ctypes
from functools import cache

import numba

from impact_damper.kernel.compiling import compiled, pointer

NUMBERS = ctypes.POINTER(ctypes.c_double)


@cache
def pointed(kernel):
    """Return a function of one or two arrays that calls a kernel with pointers to the arrays."""

    @numba.njit
    def one(a):
        kernel(pointer(a))

    @numba.njit
    def two(a, d):
        kernel(pointer(a), pointer(d))

    return lambda *arrays: (one if len(arrays) == 1 else two)(*arrays)


def part(module, name):
    """Return a function of arrays that calls the kernel `name` of a module made by `instance`."""
    call = compiled(getattr(module, name)).ctypes
    return lambda *arrays: call(*[each.ctypes.data_as(NUMBERS) for each in arrays])
