"""Arrays aligned to cache lines, and pointers to the elements of arrays, for use in kernels."""

import numpy as np
from numba import types
from numba.extending import intrinsic

from impact_damper.kernel.compiling import kernel

# Number of float64 values in a cache line of the processor, which has 64 bytes.
CACHE_LINE = 8


@kernel
def aligned(count):
    """Return an array of `count` zeros that begins at a cache line.

    A vector that crosses the border of two cache lines takes twice as long to load.
    """
    numbers = np.zeros(count + CACHE_LINE)
    before = -numbers.ctypes.data // 8 % CACHE_LINE
    return numbers[before : before + count]


@intrinsic
def pointer(typing, array):
    """Return a pointer to the first element of an array. The caller must keep the array alive.

    When a kernel passes an array to another kernel, numba changes the array's reference count twice
    with locked instructions, which take longer than some kernels do. Pointers have no reference
    count.
    """

    def generate(context, builder, signature, arguments):
        return context.make_array(signature.args[0])(context, builder, arguments[0]).data

    return types.CPointer(array.dtype)(array), generate
