"""Compile straight lines of arithmetic without numba's type inference.

All values are floats, or pairs of floats, so the LLVM code can be written at once. numba's type
inference takes a millisecond an operation, and the series of a step have thousands of them.
`lane_values` has the LLVM code of each operation.
"""

import ast
import inspect
import textwrap
from contextlib import nullcontext

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from impact_damper.kernel.lane_values import Arithmetic

# Lanes in a vector: one register of 512 bits, or several where registers are narrower.
WIDTH = 8
OFFSET = ir.IntType(64)
OPERATIONS = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}


class NotStraightError(SyntaxError):
    """A line that `straight` cannot compile; the message names its file and number."""


def straight(function):
    """Compile a function that does the same lines of arithmetic for each lane.

    Parameters
    ----------
    function : callable
        Of one argument or two, pointers to float64. The body is a loop `for i in range(lanes)`,
        with at most WIDTH lanes or a multiple of WIDTH, over assignments, also augmented ones.

        - The left side is a name, `a[1 + i]`, or, with one lane, `a[1]`.
        - The right side consists of names, constants, `a[1 + i]`, `a[1]` (the same for all lanes),
          `(1.0, 2.0)[i]` (one constant per lane), `+`, `-`, `*`, `/`, `abs(x)`, and `max(x, y)`,
          which is `x if x > y else y`.
        - `(x, y)` is a pair. Operators act on both of its values; a float beside a pair counts
          for both. A name can keep a pair, and `x, y = ...` takes it apart. With one lane, a pair
          is one register.

    Returns
    -------
    intrinsic
        Callable in kernels. If the function has other lines, compiling such a kernel raises
        NotStraightError. The attribute `py_func` is the function itself.
    """

    def generate(context, builder, signature, arguments):
        write(function, builder, arguments)
        return context.get_dummy_value()

    # numba reads the number of arguments off the signature.
    def of_one(typing, a):
        return types.void(a), generate

    def of_two(typing, a, d):
        return types.void(a, d), generate

    count = len(inspect.signature(function).parameters)
    compiled = intrinsic(of_one if count == 1 else of_two)
    compiled.py_func = function
    return compiled


def write(function, builder, pointers):
    """Write the LLVM code of a function (see `straight`) that is called with pointers.

    Raises
    ------
    NotStraightError
        If a line is none of those that `straight` describes.
    """
    code = function.__code__
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    ast.increment_lineno(tree, code.co_firstlineno - 1)
    lines = _Lines(code.co_filename, builder)
    loop, lanes = lines.loop_of(tree)
    lines.arrays = dict(zip([each.arg for each in tree.args.args], pointers, strict=True))
    lines.counter = loop.target.id
    lines.lanes, lines.width = lanes, min(lanes, WIDTH)
    lines.arithmetic = Arithmetic(builder, lines.width)
    rounds, step = (ir.Constant(OFFSET, count) for count in (lanes // lines.width, lines.width))
    # In a loop of one round LLVM would move stores behind its end, so there is none then.
    with cgutils.for_range(builder, rounds) if lanes > WIDTH else nullcontext() as turn:
        lines.first = builder.mul(turn.index, step) if turn else None
        for statement in loop.body:
            lines.visit(statement)
    lines.check_lanes_apart(loop)


def is_product(node):
    """Return whether an expression is a product."""
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)


class _Lines(ast.NodeVisitor):
    """Writes the code of assignments for `width` lanes, from lane `first` on."""

    def __init__(self, file, builder):
        self.file, self.builder = file, builder
        self.values = {}
        self.stored, self.loaded = set(), set()

    def refuse(self, node, what):
        raise NotStraightError(f"{self.file}, line {node.lineno}: {what}: {ast.unparse(node)}")

    def require(self, fits, node, what):
        if not fits:
            self.refuse(node, what)

    def loop_of(self, tree):
        """Return the loop that a function consists of, and the number of lanes."""
        loop = tree.body[0]
        match loop:
            case ast.For(
                target=ast.Name(),
                iter=ast.Call(func=ast.Name("range"), args=[ast.Constant(int(lanes))], keywords=[]),
                orelse=[],
            ) if len(tree.body) == 1:
                self.require(lanes > 0, loop, "no lanes")
                whole = lanes <= WIDTH or lanes % WIDTH == 0
                self.require(whole, loop, f"lanes are neither up to {WIDTH} nor a multiple of it")
                return loop, lanes
        self.refuse(tree, "the body is not one loop `for i in range(lanes)`")

    def check_lanes_apart(self, loop):
        """Refuse a lane that writes what another one reads or writes: lanes run side by side."""
        for array, offset in self.stored:
            for other, begin, count in self.loaded | {(*each, self.lanes) for each in self.stored}:
                same = begin == offset and count == self.lanes
                apart = other != array or begin + count <= offset or offset + self.lanes <= begin
                self.require(same or apart, loop, f"lanes share a number of {array}")

    def generic_visit(self, node):
        self.refuse(node, "cannot be compiled as straight lines")

    def visit_Assign(self, node):
        self.require(len(node.targets) == 1, node, "more than one target")
        self.store(node.targets[0], self.visit(node.value))

    def visit_AugAssign(self, node):
        value = ast.copy_location(ast.BinOp(node.target, node.op, node.value), node)
        self.store(node.target, self.visit(value))

    def store(self, target, value):
        match target:
            case ast.Tuple(elts=[first, second]):
                self.require(self.arithmetic.is_pair(value), target, "the value is no pair")
                for number, each in enumerate((first, second)):
                    self.store(each, self.arithmetic.part(value, number))
            case ast.Name(name):
                known = name in self.arrays or name == self.counter
                self.require(not known, target, "an argument or the counter is assigned to")
                self.values[name] = value
            case ast.Subscript():
                self.number(value, target)
                pointer, array, offset, own = self.element(target)
                self.require(own or self.lanes == 1, target, "all lanes would write one number")
                self.stored.add((array, offset))
                pointer = self.builder.bitcast(pointer, self.arithmetic.type.as_pointer())
                self.builder.store(value, pointer, align=8)
            case _:
                self.refuse(target, "cannot be assigned to")

    def element(self, node):
        """Return the pointer to `a[1]` or `a[1 + i]`, the array, 1, and whether i is added."""
        match node:
            case ast.Subscript(ast.Name(array), ast.Constant(int(offset))):
                own = False
            case ast.Subscript(
                ast.Name(array),
                ast.BinOp(ast.Constant(int(offset)), ast.Add(), ast.Name(self.counter)),
            ):
                own = True
            case _:
                self.refuse(node, "not of the form a[1] or a[1 + i]")
        self.require(array in self.arrays, node, f"{array} is no argument")
        self.require(type(offset) is int, node, "the index is no number")
        number = ir.Constant(OFFSET, offset)
        if own and self.first is not None:
            number = self.builder.add(number, self.first)
        pointer = self.builder.gep(self.arrays[array], [number], inbounds=True)
        return pointer, array, offset, own

    def visit_Subscript(self, node):
        if isinstance(node.value, ast.Tuple):
            return self.constants(node)
        pointer, array, offset, own = self.element(node)
        self.loaded.add((array, offset, self.lanes if own else 1))
        if own:
            pointer = self.builder.bitcast(pointer, self.arithmetic.type.as_pointer())
            return self.builder.load(pointer, align=8)
        number = self.builder.load(pointer, align=8)
        return self.arithmetic.in_all_lanes(number)

    def constants(self, node):
        """Return a number made of one constant per lane."""
        counted = isinstance(node.slice, ast.Name) and node.slice.id == self.counter
        fits = counted and 1 < self.lanes == self.width == len(node.value.elts)
        self.require(fits, node, f"not one constant per lane, at [i], for up to {WIDTH} lanes")
        return ir.Constant(self.arithmetic.type, [self.literal(each) for each in node.value.elts])

    def literal(self, node):
        """Return the value of a number in the source, with a minus sign or without."""
        match node:
            case ast.UnaryOp(ast.USub(), operand):
                return -self.literal(operand)
            case ast.Constant(value) if type(value) in (int, float):
                return float(value)
        self.refuse(node, "not a number")

    def visit_Name(self, node):
        self.require(node.id in self.values, node, "a name without a value")
        return self.values[node.id]

    def visit_Constant(self, node):
        return self.arithmetic.constant(self.literal(node))

    def visit_UnaryOp(self, node):
        self.require(isinstance(node.op, ast.USub), node, "an unknown operator")
        return self.arithmetic.negative(self.visit(node.operand))

    def visit_Tuple(self, node):
        self.require(len(node.elts) == 2, node, "not a pair")
        return self.arithmetic.pair(*(self.number(self.visit(each), each) for each in node.elts))

    def number(self, value, node):
        """Return a value, which must not be a pair."""
        self.require(not self.arithmetic.is_pair(value), node, "a pair where a number is wanted")
        return value

    def visit_BinOp(self, node):
        """Return a sum, difference, product or quotient.

        a*b + c becomes fmuladd(a, b, c). If both terms are products, the right one is fused.
        """
        kind, left, right = type(node.op), node.left, node.right
        self.require(kind in OPERATIONS, node, "an unknown operator")
        if kind in (ast.Add, ast.Sub) and is_product(right):
            first = self.visit(right.left)
            first = self.arithmetic.negative(first) if kind is ast.Sub else first
            return self.arithmetic.fused(first, self.visit(right.right), self.visit(left))
        if kind in (ast.Add, ast.Sub) and is_product(left):
            last = self.visit(right)
            last = self.arithmetic.negative(last) if kind is ast.Sub else last
            return self.arithmetic.fused(self.visit(left.left), self.visit(left.right), last)
        return self.arithmetic.combined(OPERATIONS[kind], self.visit(left), self.visit(right))

    def visit_Call(self, node):
        counts = {"abs": 1, "max": 2}
        name = node.func.id if isinstance(node.func, ast.Name) else None
        self.require(name in counts, node, "neither abs nor max")
        fits = len(node.args) == counts[name] and not node.keywords
        self.require(fits, node, f"{name} takes {counts[name]} here")
        values = [self.number(self.visit(each), each) for each in node.args]
        called = self.arithmetic.modulus if name == "abs" else self.arithmetic.larger
        return called(*values)
