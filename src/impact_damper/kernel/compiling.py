"""Compile kernels, which are functions in machine code, with numba. Decorators for functions:

    kernel       The function is compiled on the first call, and its machine code is cached.
    kernel_only  Only kernels can call the function. Its machine code is cached with each caller.
    inlined      Kernels that call the function contain a copy of the function.

numba compiles a cached kernel again after an edit of the kernel's own file. But numba does not
notice an edit of another file whose functions the kernel calls. Therefore each module has a cache
folder, and the folder's name is a digest of all files on which the module's kernels can depend.
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

# Time of compilation (s) after which MESSAGE is printed.
PATIENCE = 1.0
MESSAGE = "impact_damper: compiling kernels; later sessions will load them from the cache"
# Name of the event that `compiled` reports to numba's listeners while a kernel is compiled.
COMPILING = "impact_damper:compile"
# Number of float64 numbers in a cache line of the processor (64 bytes).
CACHE_LINE = 8


@cache
def cache_directory(*paths) -> Path:
    """Return the folder for the compiled kernels of the modules in the files `paths`."""
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    root = Path(chosen) if chosen else platformdirs.user_cache_path("impact-damper")
    path = root / kernel_digest(*paths)
    try:
        path.mkdir(parents=True, exist_ok=True)
    except OSError:
        path = Path(tempfile.mkdtemp(prefix="impact-damper-"))
    return path


# Folder for the modules that `instances` generates, and for the compiled kernels of these modules.
CACHE_DIRECTORY = cache_directory()


@contextmanager
def own_cache(function):
    """Return a context in which numba caches `function` in the cache folder of its module."""
    path = Path(function.__code__.co_filename)
    generated = path.is_relative_to(CACHE_DIRECTORY)
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = str(CACHE_DIRECTORY if generated else cache_directory(path))
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before


# CONTRACT: LLVM may fuse a multiplication with an addition, but not change arithmetic otherwise.
# "nogil": kernels release Python's global interpreter lock, so that threads run in parallel.
# "error_model": with "numpy", a division by zero gives infinity or NaN and raises no error.
CONTRACT = ("contract",)
SETTINGS = {"cache": True, "nogil": True, "fastmath": set(CONTRACT), "error_model": "numpy"}


def kernel(function, **options):
    """Turn a function into a kernel. `options` are numba options that override SETTINGS."""
    with own_cache(function):
        return numba.njit(no_cfunc_wrapper=True, **SETTINGS | options)(function)


kernel_only = partial(kernel, no_cpython_wrapper=True, cache=False)
inlined = partial(kernel, inline="always")


@kernel
def aligned(count):
    """Return an array of `count` zeros. Its first number is the first number of a cache line."""
    numbers = np.zeros(count + CACHE_LINE)
    before = -numbers.ctypes.data // 8 % CACHE_LINE
    return numbers[before : before + count]


@intrinsic
def pointer(typing, array):
    """Return a pointer to the first element of an array. The caller must keep the array alive."""

    def generate(context, builder, signature, arguments):
        return context.make_array(signature.args[0])(context, builder, arguments[0]).data

    return types.CPointer(array.dtype)(array), generate


def signature_of(function):
    """Return numba's signature of a kernel that takes pointers to float64 and returns nothing."""
    count = len(inspect.signature(function.py_func).parameters)
    return types.void(*[types.CPointer(types.float64)] * count)


@cache
def compiled(function):
    """Compile a kernel as a C function. All arguments of the kernel must be pointers to float64."""
    told = event.trigger_event(COMPILING, data={"dispatcher": function})
    with own_cache(function.py_func), told:
        return numba.cfunc(signature_of(function), **SETTINGS)(function.py_func)


def by_address(function):
    """Return a stand-in for a kernel. A call of the stand-in jumps to the kernel's address.

    Without the stand-in, LLVM would compile the kernel again as part of each caller. LLVM must
    know the kernel's address before numba loads a caller from the cache. Therefore `by_address` is
    called at the top level of a module, not inside a function.
    """
    name = f"{function.py_func.__module__}.{function.py_func.__name__}"
    llvmlite.binding.add_symbol(name, compiled(function).address)
    return types.ExternalFunction(name, signature_of(function))


@intrinsic
def call_at(typing, address, numbers):
    """Call a kernel with the pointer `numbers` as argument. `address` is the kernel's address."""

    def generate(context, builder, signature, arguments):
        address, numbers = arguments
        kernel = ir.FunctionType(ir.VoidType(), [numbers.type]).as_pointer()
        builder.call(builder.inttoptr(address, kernel), [numbers])
        return context.get_dummy_value()

    return types.void(address, numbers), generate


class Progress(event.Listener):
    """Prints MESSAGE once, when compiling kernels has taken more than PATIENCE seconds in total."""

    def __init__(self):
        self.depth, self.spent, self.written = 0, 0.0, False

    def on_start(self, started):
        if _is_own(started):
            if self.depth == 0:
                self.begun, self.collecting = time.perf_counter(), gc.isenabled()
                # Garbage collection would take a fifth of the compilation time, for little gain.
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
    return compiled.data["dispatcher"].py_func.__module__.startswith("impact_damper")


_progress = Progress()
for _kind in ("numba:compile", COMPILING):
    event.register(_kind, _progress)
