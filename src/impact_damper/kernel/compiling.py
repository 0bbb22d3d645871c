"""Compile kernels with numba, cache their machine code and call them. Decorators for functions:

    kernel       The function is compiled on the first call, and cached.
    kernel_only  Only kernels can call the function; it is cached as part of these kernels.
    inlined      Kernels that call the function contain a copy of the function.

numba compiles a cached function again after an edit of the file that defines it, but not after an
edit of a function that it calls. Therefore each module has a folder of its own, whose name is the
digest of all modules that its kernels can depend on.
"""

import gc
import inspect
import os
import sys
import tempfile
import time
from contextlib import contextmanager
from functools import cache, partial
from pathlib import Path

import llvmlite.binding
import numba
import numpy as np
import platformdirs
from llvmlite import ir
from numba import types
from numba.core import event
from numba.extending import intrinsic

from impact_damper.kernel.sources import kernel_digest

# Time spent on compilation, in s, after which MESSAGE is printed.
PATIENCE = 1.0
MESSAGE = "impact_damper: compiling kernels; later sessions will load them from the cache"
# Event of the compilation of a kernel that is called by address.
COMPILING = "impact_damper:compile"
# Number of float64 values in one of the processor's cache lines of 64 bytes.
CACHE_LINE = 8


@cache
def cache_directory(*paths) -> Path:
    """Return the folder of the compiled kernels of the modules `paths`.

    If the usual folder cannot be made, a temporary folder takes its place.
    """
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    root = Path(chosen) if chosen else platformdirs.user_cache_path("impact-damper")
    path = root / kernel_digest(*paths)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError:
        path = Path(tempfile.mkdtemp(prefix="impact-damper-"))
    return path


# Folder of the generated modules and their kernels. They depend on this subpackage and its imports.
CACHE_DIRECTORY = cache_directory()


@contextmanager
def own_cache(function):
    """Return a context in which numba caches a decorated function in the folder of its module.

    At its end the context restores the user's setting of the folder.
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
# be less accurate and slower. With "nogil" kernels release Python's global interpreter lock and run
# in parallel in Python threads, without parallel compilation by numba. With the error model "numpy"
# a division by zero gives infinity or NaN and raises nothing.
CONTRACT = ("contract",)
SETTINGS = {"cache": True, "nogil": True, "fastmath": set(CONTRACT), "error_model": "numpy"}


def kernel(function, **options):
    """Decorate a kernel; `no_cfunc_wrapper` saves a tenth of the compile time."""
    with own_cache(function):
        return numba.njit(no_cfunc_wrapper=True, **SETTINGS | options)(function)


kernel_only = partial(kernel, no_cpython_wrapper=True, cache=False)
inlined = partial(kernel, inline="always")


@kernel
def aligned(count):
    """Return `count` zeros from the beginning of a cache line, so that vectors load fast."""
    numbers = np.zeros(count + CACHE_LINE)
    before = -numbers.ctypes.data // 8 % CACHE_LINE
    return numbers[before : before + count]


@intrinsic
def pointer(typing, array):
    """Return a pointer to the first element of an array, which the caller must keep alive.

    numba counts references to arrays with locked instructions, which are slower than some kernels.
    """

    def generate(context, builder, signature, arguments):
        return context.make_array(signature.args[0])(context, builder, arguments[0]).data

    return types.CPointer(array.dtype)(array), generate


def signature_of(function):
    """Return the signature of a kernel that takes pointers to float64 and returns nothing."""
    count = len(inspect.signature(function.py_func).parameters)
    return types.void(*[types.CPointer(types.float64)] * count)


@cache
def compiled(function):
    """Return the compiled cfunc of a kernel (see `signature_of`); `call_at` takes its `address`."""
    told = event.trigger_event(COMPILING, data={"dispatcher": function})
    with own_cache(function.py_func), told:
        return numba.cfunc(signature_of(function), **SETTINGS)(function.py_func)


def by_address(function):
    """Return a stand-in for a kernel; calls of the stand-in jump to the kernel's address.

    Otherwise LLVM compiles a called kernel again as a part of each caller. A cached caller refers
    to the kernel by name. The name must be bound to an address before the caller is loaded.
    Therefore a module that the modules of all callers import calls `by_address` when imported.
    """
    name = f"{function.py_func.__module__}.{function.py_func.__name__}"
    llvmlite.binding.add_symbol(name, compiled(function).address)
    return types.ExternalFunction(name, signature_of(function))


@intrinsic
def call_at(typing, address, numbers):
    """Call the kernel at `address`, an integer, with `numbers`, a pointer to float64."""

    def generate(context, builder, signature, arguments):
        address, numbers = arguments
        kernel = ir.FunctionType(ir.VoidType(), [numbers.type]).as_pointer()
        builder.call(builder.inttoptr(address, kernel), [numbers])
        return context.get_dummy_value()

    return types.void(address, numbers), generate


class Progress(event.Listener):
    """Adds up the time of compiling this package's kernels; prints MESSAGE once after PATIENCE.

    The garbage collector is switched off during compilation, because it finds little garbage and
    would take a fifth of the time.
    """

    def __init__(self):
        self.depth, self.spent, self.written = 0, 0.0, False

    def on_start(self, started):
        if _is_own(started):
            if self.depth == 0:
                self.begun, self.collecting = time.perf_counter(), gc.isenabled()
                gc.disable()
            self._change(1)

    def on_end(self, ended):
        if _is_own(ended):
            self._change(-1)
            if self.depth == 0:
                self.spent += time.perf_counter() - self.begun
                if self.collecting:
                    gc.enable()

    def _change(self, step):
        self.depth += step
        spent = self.spent + time.perf_counter() - self.begun
        if spent > PATIENCE and not self.written:
            self.written = True
            print(MESSAGE, file=sys.stderr, flush=True)


def _is_own(compiled):
    """Return whether an event concerns a function of this package or of a generated module."""
    return compiled.data["dispatcher"].py_func.__module__.startswith("impact_damper")


_progress = Progress()
for _kind in ("numba:compile", COMPILING):
    event.register(_kind, _progress)
