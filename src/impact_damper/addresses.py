"""Kernels that others call by address, so that they are compiled once.

LLVM compiles what a kernel calls together with it. A dozen kernels call the steps, which take it
most of a second each time.
"""

import ctypes
import inspect
import os
import sys
import threading

import llvmlite.binding
import numba
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from impact_damper.accelerate import SETTINGS

_COMPILING = threading.Lock()


def by_address(function):
    """What kernels call in place of a kernel that takes pointers to numbers and returns nothing.

    Compiled code knows by name a cell with the address, which at first is that of a function that
    compiles the kernel, or takes it from the cache. An error there, or an interruption, ends the
    process: the compiled code that waits cannot be told, and would go on as if the kernel had run.

    Parameters
    ----------
    function : numba.core.dispatcher.Dispatcher
        Its name and that of its module are its own in the process.
    """
    name = f"{function.__module__}.{function.__name__}"
    count = len(inspect.signature(function.py_func).parameters)
    prototype = ctypes.CFUNCTYPE(None, *[ctypes.c_void_p] * count)
    kept = []

    @prototype
    def compile_and_call(*pointers):
        try:
            with _COMPILING:
                if not kept:
                    numbers = types.CPointer(types.float64)
                    compiled = numba.cfunc(types.void(*[numbers] * count), **SETTINGS)
                    kept.append(compiled(function.py_func))
                    cell.value = kept[0].address
        except BaseException:
            sys.excepthook(*sys.exc_info())
            sys.stderr.flush()
            os._exit(1)
        prototype(cell.value)(*pointers)

    cell = ctypes.cast(compile_and_call, ctypes.c_void_p)
    llvmlite.binding.add_symbol(name, ctypes.addressof(cell))

    @intrinsic
    def call(typing, *pointers):
        def generate(context, builder, signature, arguments):
            values = cgutils.unpack_tuple(builder, arguments[0])
            address = ir.FunctionType(ir.VoidType(), [value.type for value in values]).as_pointer()
            place = builder.module.globals.get(name)
            if place is None:
                place = ir.GlobalVariable(builder.module, address, name)
            builder.call(builder.load(place), values)
            return context.get_dummy_value()

        return types.void(types.StarArgTuple.from_types(pointers)), generate

    call.kept = cell, compile_and_call
    return call
