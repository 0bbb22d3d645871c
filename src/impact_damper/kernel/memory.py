"""Memory that kernels share: arrays that begin at a cache line, and pointers to their numbers."""

import numpy as np
from numba import types
from numba.extending import intrinsic

from impact_damper.kernel.compiling import kernel

# Numbers of eight bytes in a cache line of the processor.
CACHE_LINE = 8


@kernel
def aligned(count):
    """Return an array of zeros that begins at a cache line.

    A vector that lies across two cache lines takes twice as long to load.
    """
    numbers = np.zeros(count + CACHE_LINE)
    before = -numbers.ctypes.data // 8 % CACHE_LINE
    return numbers[before : before + count]


@intrinsic
def pointer(typing, array):
    """Return a pointer to the numbers of an array, which the caller must keep alive.

    Each call that passes an array counts references to the array, twice and by locked
    instructions, which takes longer than some kernels. Pointers are not counted.
    """

    def generate(context, builder, signature, arguments):
        return context.make_array(signature.args[0])(context, builder, arguments[0]).data

    return types.CPointer(array.dtype)(array), generate
