"""How kernels are compiled with numba, and where their machine code is kept.

    kernel       compiled on the first call, and cached
    kernel_only  not callable from Python; cached only as part of the kernels that call it
    inlined      compiled as part of its callers and not by itself

numba compiles a cached function again after an edit of the file that defines it, but not after an
edit of a function that it calls. Therefore each module has a folder of its own, whose name is the
digest of all modules that its kernels can depend on.
"""

import os
import tempfile
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path

import numba
import platformdirs

from impact_damper.kernel.progress import show_progress
from impact_damper.kernel.sources import kernel_digest


@cache
def cache_directory(*paths) -> Path:
    """Return the folder of the compiled kernels of the modules `paths`.

    It is a temporary folder if the usual one is not writable.
    """
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    root = Path(chosen) if chosen else platformdirs.user_cache_path("impact-damper")
    path = root / kernel_digest(*paths)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError:
        path = Path(tempfile.mkdtemp(prefix="impact-damper-"))
    return path


# Folder of the generated modules and of their kernels, which depend on this room alone.
CACHE_DIRECTORY = cache_directory()


@contextmanager
def own_cache(function):
    """Let numba cache a function that is decorated within this context in the folder of its module.

    numba chooses the folder of a function when the function is decorated. At its end the context
    restores the user's setting of the folder.
    """
    path = Path(function.__code__.co_filename)
    generated = path.is_relative_to(CACHE_DIRECTORY)
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_DIRECTORY if generated else cache_directory(path))
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
    with own_cache(function):
        return numba.njit(no_cfunc_wrapper=True, **SETTINGS | options)(function)


kernel_only = partial(kernel, no_cpython_wrapper=True, cache=False)
inlined = partial(kernel, inline="always")

show_progress()
