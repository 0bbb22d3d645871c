"""How kernels are compiled with numba, and where their machine code is kept.

    kernel       compiled on the first call, and cached
    kernel_only  not callable from Python; cached only as part of the kernels that call it
    inlined      compiled as part of its callers and not by itself

numba compiles a cached function again after an edit of the file that defines it, but not after an
edit of a function that it calls. Therefore the cache is a folder whose name is the digest of all
modules that a kernel can depend on.
"""

import os
import tempfile
from contextlib import contextmanager
from functools import partial
from pathlib import Path

import numba
import platformdirs

from impact_damper.kernel import source_digest
from impact_damper.kernel.progress import show_progress


def _cache_directory() -> Path:
    """Return the folder of compiled kernels, a temporary one if the usual one is not writable."""
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    root = Path(chosen) if chosen else platformdirs.user_cache_path("impact-damper")
    path = root / source_digest()
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError:
        path = Path(tempfile.mkdtemp(prefix="impact-damper-"))
    return path


CACHE_DIRECTORY = _cache_directory()


@contextmanager
def own_cache():
    """Let numba cache the functions that are decorated within this context in CACHE_DIRECTORY.

    numba chooses the folder of a function when the function is decorated. At its end the context
    restores the user's setting of the folder.
    """
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_DIRECTORY)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


# "contract" allows fused multiply-add and no other change of the arithmetic: reordered sums would
# be both less accurate and slower. With "nogil" kernels release Python's global interpreter lock,
# so they run in parallel in Python threads and need no parallel compilation by numba. With the
# error model "numpy" a division by zero gives infinity or NaN and raises nothing.
CONTRACT = ("contract",)
SETTINGS = {"cache": True, "nogil": True, "fastmath": set(CONTRACT), "error_model": "numpy"}


def kernel(function, **options):
    """Decorate a kernel.

    With `no_cfunc_wrapper` numba compiles no wrapper for calls from C, which saves a tenth of the
    compile time.
    """
    with own_cache():
        return numba.njit(no_cfunc_wrapper=True, **SETTINGS | options)(function)


kernel_only = partial(kernel, no_cpython_wrapper=True, cache=False)
inlined = partial(kernel, inline="always")

show_progress()
