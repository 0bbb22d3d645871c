"""All numba settings in one place: how kernels are compiled and where they are kept.

Compiled kernels are cached in a directory named by the digest of all modules that hold kernels
or write them: those that name this one or a decorator of it, and `recurrence`. Numba notices an
edit only in the file of the function itself, so a kernel that calls into another module would
otherwise go on with the old code. What a kernel uses, constants too, must therefore stand in such
a module.
"""

import hashlib
import os
import tempfile
from functools import partial
from pathlib import Path

import numba
import numpy as np
import platformdirs
from numba import types
from numba.core.codegen import get_host_cpu_features
from numba.extending import intrinsic

MARKS = b"impact_damper.kernel.compiling", b"@kernel", b"@within"


def source_digest() -> str:
    """Digest of every module that holds or writes kernels, and of numba's version."""
    digest = hashlib.sha256(numba.__version__.encode())
    root = Path(__file__).parents[1]
    for path in sorted(root.rglob("*.py")):
        source = path.read_bytes()
        if any(mark in source for mark in MARKS) or path.name in ("recurrence.py", "packed.py"):
            digest.update(path.relative_to(root).as_posix().encode() + b"\0" + source)
    return digest.hexdigest()[:16]


def _cache_directory() -> Path:
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    root = Path(chosen) if chosen else platformdirs.user_cache_path("impact-damper")
    path = root / source_digest()
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError:
        path = Path(tempfile.mkdtemp(prefix="impact-damper-"))
    return path


CACHE_DIRECTORY = _cache_directory()
numba.config.CACHE_DIR = str(CACHE_DIRECTORY)

# Vectors as wide as the processor has: LLVM takes half of that where it fears a slower clock.
if "+avx512f" in get_host_cpu_features():
    numba.config.CPU_FEATURES = f"{get_host_cpu_features()},-prefer-256-bit"

# "contract" allows fused multiply-add and nothing else: reordering sums would
# cost both digits and speed. Kernels release the interpreter lock, so threads
# spread them over cores without a parallel compilation of their own.
CONTRACT = ("contract",)
SETTINGS = {"cache": True, "nogil": True, "fastmath": set(CONTRACT), "error_model": "numpy"}
# Without a wrapper for C, which nothing calls: with each wrapper compiling takes a tenth longer.
kernel = partial(numba.njit, no_cfunc_wrapper=True, **SETTINGS)

# For a function that only kernels call: no way in from Python, kept as part of its callers.
within = partial(kernel, no_cpython_wrapper=True, cache=False)

# For a function with few callers: compiled as part of them and not by itself as well.
inlined = partial(kernel, inline="always")

# Numbers in a line of the processor's cache.
LINE = 8


@kernel
def aligned(count):
    """Zeros from the beginning of a cache line on.

    A vector that lies across two lines takes twice as long to load; where arrays begin is chance.
    """
    numbers = np.zeros(count + LINE)
    before = -numbers.ctypes.data // 8 % LINE
    return numbers[before : before + count]


@intrinsic
def pointer(typing, array):
    """Pointer to the numbers of an array, which its caller keeps alive.

    Each call that passes an array counts references to it, twice and by locked instructions: more
    than some of the kernels take. Pointers are not counted.
    """

    def generate(context, builder, signature, arguments):
        return context.make_array(signature.args[0])(context, builder, arguments[0]).data

    return types.CPointer(array.dtype)(array), generate
