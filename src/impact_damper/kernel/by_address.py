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

from impact_damper.kernel.compiling import SETTINGS

_COMPILING = threading.Lock()
_KEPT = {}  # by name: what compiled code holds the addresses of


def by_address(function):
    """What kernels call in place of a kernel that takes pointers to numbers and returns nothing.

    Compiled code finds the kernel's address in a cell, known to LLVM by the kernel's name. While
    it is empty, it calls a function that compiles the kernel or takes it from the cache, and
    looks again. An error there, or an interruption, ends the process: compiled code cannot be told
    of it. To have an error raised, call `compile` before.

    Parameters
    ----------
    function : numba.core.dispatcher.Dispatcher

    Returns
    -------
    intrinsic
        To be called from kernels with pointers to float64. Its `compile` fills the cell and returns
        the address, for `call_at`.

    Raises
    ------
    ValueError
        If a kernel of this module and name has an address already.
    """
    name = f"{function.__module__}.{function.__name__}"
    if name in _KEPT:
        raise ValueError(f"function = {name}: has an address already")
    count = len(inspect.signature(function.py_func).parameters)
    cells = (ctypes.c_void_p * 2)()  # addresses of the kernel, and of what fills the first cell
    kept = _KEPT[name] = [cells]

    def compile_once():
        with _COMPILING:
            if cells[0] is None:
                numbers = types.CPointer(types.float64)
                compiled = numba.cfunc(types.void(*[numbers] * count), **SETTINGS)
                kept.append(compiled(function.py_func))
                cells[0] = kept[-1].address
            return cells[0]

    @ctypes.CFUNCTYPE(None)
    def compile_or_end():
        try:
            compile_once()
        except BaseException:
            sys.excepthook(*sys.exc_info())
            sys.stderr.flush()
            os._exit(1)

    kept.append(compile_or_end)
    cells[1] = ctypes.cast(compile_or_end, ctypes.c_void_p).value
    llvmlite.binding.add_symbol(name, ctypes.addressof(cells))

    @intrinsic
    def call(typing, *pointers):
        def generate(context, builder, signature, arguments):
            _call(builder, name, cgutils.unpack_tuple(builder, arguments[0]))
            return context.get_dummy_value()

        return types.void(types.StarArgTuple.from_types(pointers)), generate

    call.compile, call.py_func = compile_once, function.py_func
    return call


@intrinsic
def call_at(typing, address, numbers):
    """Call the kernel at an address with a pointer to numbers."""

    def generate(context, builder, signature, arguments):
        address, numbers = arguments
        kernel = ir.FunctionType(ir.VoidType(), [numbers.type]).as_pointer()
        builder.call(builder.inttoptr(address, kernel), [numbers])
        return context.get_dummy_value()

    return types.void(address, numbers), generate


def _call(builder, name, values):
    """Call the kernel whose cells have this name as soon as there is an address."""
    nothing = ir.VoidType()
    kernel = ir.FunctionType(nothing, [value.type for value in values]).as_pointer()
    filling = ir.FunctionType(nothing, []).as_pointer()
    cells = builder.module.globals.get(name)
    if cells is None:
        kind = ir.LiteralStructType([kernel, filling])
        cells = ir.GlobalVariable(builder.module, kind, name)
    looking, missing, found = map(builder.append_basic_block, ("looking", "missing", "found"))
    builder.branch(looking)
    builder.position_at_end(looking)
    address = builder.load(cgutils.gep_inbounds(builder, cells, 0, 0))
    builder.cbranch(cgutils.is_null(builder, address), missing, found)
    builder.position_at_end(missing)
    builder.call(builder.load(cgutils.gep_inbounds(builder, cells, 0, 1)), [])
    builder.branch(looking)
    builder.position_at_end(found)
    builder.call(address, values)
