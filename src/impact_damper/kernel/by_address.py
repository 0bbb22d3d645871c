"""Kernels that others call by address, so that each is compiled once.

LLVM compiles a called kernel again as part of each caller. A dozen kernels call the steps, each
of which takes most of a second to compile.
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
    """Signature of a kernel that takes pointers to float64 and returns nothing."""
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
        Its `address` is for `call_at`.
    """
    with own_cache():
        return numba.cfunc(signature_of(function), **SETTINGS)(function.py_func)


def by_address(function):
    """Compile a kernel, and return the function by which other kernels call its address.

    A cached caller refers to the kernel by name, and this name must be bound to an address before
    the caller is loaded from the cache. Therefore call this function at the import of a module that
    the modules of all callers import.

    Parameters
    ----------
    function : numba.core.dispatcher.Dispatcher
        As of `compiled`.

    Returns
    -------
    numba.types.ExternalFunction
    """
    name = f"{function.__module__}.{function.__name__}"
    llvmlite.binding.add_symbol(name, compiled(function).address)
    return types.ExternalFunction(name, signature_of(function))


@intrinsic
def call_at(typing, address, numbers):
    """Call the kernel at an address with a pointer to numbers."""

    def generate(context, builder, signature, arguments):
        address, numbers = arguments
        kernel = ir.FunctionType(ir.VoidType(), [numbers.type]).as_pointer()
        builder.call(builder.inttoptr(address, kernel), [numbers])
        return context.get_dummy_value()

    return types.void(address, numbers), generate
