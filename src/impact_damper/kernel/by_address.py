"""Kernels that other kernels call through their address, so that each is compiled only once.

Otherwise LLVM compiles a called kernel again as a part of each caller. A dozen kernels call the
integration steps, and one step takes most of a second to compile.
"""

import inspect
from functools import cache

import llvmlite.binding
import numba
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from impact_damper.kernel.compiling import SETTINGS, own_cache


def signature_of(function):
    """Return the signature of a kernel that takes pointers to float64 and returns nothing."""
    count = len(inspect.signature(function.py_func).parameters)
    return types.void(*[types.CPointer(types.float64)] * count)


@cache
def compiled(function):
    """Compile a kernel (see `signature_of`), or load it from the cache.

    Parameters
    ----------
    function : numba.core.dispatcher.Dispatcher

    Returns
    -------
    numba.core.ccallback.CFunc
        The compiled kernel. `call_at` takes its `address`.
    """
    with own_cache(function.py_func):
        return numba.cfunc(signature_of(function), **SETTINGS)(function.py_func)


def by_address(function):
    """Return a stand-in for a kernel; calls of the stand-in jump to the kernel's address.

    A cached caller refers to the kernel by name, and this name must be bound to an address before
    the caller is loaded from the cache. Therefore `by_address` is called when a module is imported
    that the modules of all callers import.

    Parameters
    ----------
    function : numba.core.dispatcher.Dispatcher
        A kernel that takes pointers to float64 and returns nothing.

    Returns
    -------
    numba.types.ExternalFunction
        Callable in kernels.
    """
    name = f"{function.__module__}.{function.__name__}"
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
