"""How kernels are compiled with numba, and where their machine code is kept.

    kernel       compiled on the first call, and cached
    kernel_only  not callable from Python; cached only as part of the kernels that call it
    inlined      compiled as part of its callers and not by itself

numba notices an edit of the file in which a cached function stands, and not an edit of what the
function calls. So the cache is a folder named by the digest of all modules a kernel can depend on.
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
    """Within this context numba keeps decorated functions in CACHE_DIRECTORY.

    numba chooses the folder of a function when it is decorated. Afterwards the setting is what
    the user made it.
    """
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_DIRECTORY)
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


# "contract" allows fused multiply-add and nothing else: reordering sums would
# cost both digits and speed. Kernels release the interpreter lock, so threads
# spread them over cores without a parallel compilation of their own.
CONTRACT = ("contract",)
SETTINGS = {"cache": True, "nogil": True, "fastmath": set(CONTRACT), "error_model": "numpy"}


def kernel(function, **options):
    """Decorate a kernel.

    numba compiles no wrapper for calls from C, which would take a tenth of the time.
    """
    with own_cache():
        return numba.njit(no_cfunc_wrapper=True, **SETTINGS | options)(function)


kernel_only = partial(kernel, no_cpython_wrapper=True, cache=False)
inlined = partial(kernel, inline="always")

show_progress()
