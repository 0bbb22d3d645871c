"""Compile arithmetic without branches ("straight lines"), without numba's slow type inference.

The Taylor series of a step take thousands of operations. numba's type inference needs a millisecond
for each. With one lane, an instruction can operate on two numbers, a pair.
"""

import ast
from contextlib import nullcontext
from functools import partial

from llvmlite import ir
from llvmlite.binding import get_host_cpu_features
from numba.core import cgutils

from impact_damper.kernel.branches import OPERATORS, Body
from impact_damper.kernel.compiling import CONTRACT

# Number of lanes in a vector. A register holds 8 doubles with AVX-512, and at most 4 without.
WIDTH = 8 if get_host_cpu_features().get("avx512f") else 4
FLOAT = ir.DoubleType()
PAIR = ir.VectorType(FLOAT, 2)
INDEX, OFFSET = ir.IntType(32), ir.IntType(64)


def straight(function):
    """Decorate a function whose body is a loop `for i in range(lanes)` of assignments.

    The number of lanes is at most WIDTH, or a multiple of WIDTH. The left side of `=`, `+=` or `-=`
    is a name, an array entry such as `a[1 + i]` or, with one lane, `a[1]`. The right side may have
    names, constants, `a[1 + i]`, `a[1]` (equal in all lanes), `(1.0, 2.0)[i]` (a constant for each
    lane), `+`, `-`, `*`, `/`, `abs(x)`, and `max(x, y)`, which is `x if x > y else y`. `(x, y)` is
    a pair of numbers, and `x, y = ...` unpacks a pair. An operator acts on both numbers of a pair.
    """
    function.write = write
    return function


def write(function, builder, pointers):
    """Write LLVM code for a function decorated with `straight`, called with the given pointers."""
    lines = _Lines(builder, function)
    (loop,) = lines.tree.body
    lanes = loop.iter.args[0].value
    width = min(lanes, WIDTH)
    lines.values = dict(zip([each.arg for each in lines.tree.args.args], pointers, strict=True))
    lines.arithmetic = Arithmetic(builder, width)
    rounds, step = (ir.Constant(OFFSET, count) for count in (lanes // width, width))
    # If one vector holds all lanes, no loop is written, because LLVM would delay stores in a loop.
    with cgutils.for_range(builder, rounds) if lanes > WIDTH else nullcontext() as turn:
        lines.first = builder.mul(turn.index, step) if turn else None
        lines.run(loop.body)


def is_product(node):
    """Return whether an expression is a product."""
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)


class _Lines(Body):
    """Writes the LLVM code of assignments for `arithmetic.width` lanes, from lane `first` on."""

    def set(self, name, value):
        self.values[name] = value

    def store(self, target, value):
        if isinstance(target, ast.Tuple):
            value = [self.arithmetic.part(value, number) for number in range(2)]
        if not isinstance(target, ast.Subscript):
            super().store(target, value)
        else:
            self.builder.store(value, self.pointer(target), align=8)

    def pointer(self, node):
        own = isinstance(node.slice, ast.BinOp)
        number = ir.Constant(OFFSET, (node.slice.left if own else node.slice).value)
        if own and self.first is not None:
            number = self.builder.add(number, self.first)
        pointer = self.builder.gep(self.values[node.value.id], [number], inbounds=True)
        return self.builder.bitcast(pointer, self.arithmetic.type.as_pointer()) if own else pointer

    def visit_Subscript(self, node):
        if isinstance(node.value, ast.Tuple):
            return ir.Constant(self.arithmetic.type, list(map(ast.literal_eval, node.value.elts)))
        number = self.builder.load(self.pointer(node), align=8)
        same = number.type == self.arithmetic.type
        return number if same else self.arithmetic.in_all_lanes(number)

    def visit_Constant(self, node):
        return self.arithmetic.constant(float(node.value))

    def visit_UnaryOp(self, node):
        return self.arithmetic.negative(self.visit(node.operand))

    def visit_Tuple(self, node):
        return self.arithmetic.pair(*map(self.visit, node.elts))

    def visit_BinOp(self, node):
        kind, left, right = type(node.op), node.left, node.right
        if kind in (ast.Add, ast.Sub) and is_product(right):
            first = self.visit(right.left)
            first = self.arithmetic.negative(first) if kind is ast.Sub else first
            return self.arithmetic.fused(first, self.visit(right.right), self.visit(left))
        if kind in (ast.Add, ast.Sub) and is_product(left):
            last = self.visit(right)
            last = self.arithmetic.negative(last) if kind is ast.Sub else last
            return self.arithmetic.fused(self.visit(left.left), self.visit(left.right), last)
        return self.arithmetic.combined(OPERATORS[kind][1], self.visit(left), self.visit(right))

    def visit_Call(self, node):
        called = {"abs": self.arithmetic.modulus, "max": self.arithmetic.larger}
        if node.func.id not in called:
            self.generic_visit(node)
        return called[node.func.id](*map(self.visit, node.args))


class Arithmetic:
    """Writes operations for `width` lanes, and returns their results as LLVM values.

    With one lane a number is a double, and a pair is a vector of two doubles. With more lanes a
    number is a vector with one double per lane, and a pair is a tuple of two such vectors.
    """

    def __init__(self, builder, width):
        self.builder, self.width = builder, width
        self.type = FLOAT if width == 1 else ir.VectorType(FLOAT, width)

    def constant(self, value):
        """Return an LLVM constant that has the Python number `value` in each lane."""
        return ir.Constant(self.type, value if self.width == 1 else [value] * self.width)

    def in_all_lanes(self, value):
        """Return a number that has the LLVM double `value` in each lane."""
        return value if self.width == 1 else self._repeated(value, self.width)

    def pair(self, first, second):
        """Return a pair of two numbers."""
        if self.width > 1:
            return first, second
        pair = ir.Constant(PAIR, ir.Undefined)
        for place, number in enumerate((first, second)):
            pair = self.builder.insert_element(pair, number, ir.Constant(INDEX, place))
        return pair

    def is_pair(self, value):
        """Return whether a value is a pair."""
        return isinstance(value, tuple) or (self.width == 1 and value.type == PAIR)

    def part(self, pair, place):
        """Return the first (place 0) or the second (place 1) number of a pair."""
        if self.width > 1:
            return pair[place]
        return self.builder.extract_element(pair, ir.Constant(INDEX, place))

    def combined(self, instruction, *values):
        """Apply an LLVM instruction, such as "fadd", to operands: numbers or pairs of numbers."""
        return self._each(partial(getattr(self.builder, instruction), flags=CONTRACT), *values)

    def negative(self, value):
        """Return a number or pair with the opposite sign."""
        return self.combined("fneg", value)

    def fused(self, first, second, third):
        """Return first * second + third, rounded only once if the processor can do so."""
        return self._each(partial(self._intrinsic, "llvm.fmuladd"), first, second, third)

    def modulus(self, number):
        """Return the modulus of a number."""
        return self._intrinsic("llvm.fabs", number)

    def larger(self, first, second):
        """Return the larger of two numbers, or the second number if one of them is NaN."""
        return self.builder.select(self.builder.fcmp_ordered(">", first, second), first, second)

    def _repeated(self, value, count):
        vector = ir.Constant(ir.VectorType(FLOAT, count), ir.Undefined)
        vector = self.builder.insert_element(vector, value, ir.Constant(INDEX, 0))
        zeros = ir.Constant(ir.VectorType(INDEX, count), [0] * count)
        return self.builder.shuffle_vector(vector, vector, zeros)

    def _intrinsic(self, name, *values):
        kind = values[0].type
        suffix = f"v{kind.count}f64" if isinstance(kind, ir.VectorType) else "f64"
        signature = ir.FunctionType(kind, [kind] * len(values))
        function = cgutils.get_or_insert_function(
            self.builder.module, signature, f"{name}.{suffix}"
        )
        return self.builder.call(function, values)

    def _each(self, operation, *values):
        if not any(map(self.is_pair, values)):
            return operation(*values)
        if self.width > 1:
            pairs = [value if self.is_pair(value) else (value, value) for value in values]
            return tuple(map(operation, *pairs))
        pairs = [value if self.is_pair(value) else self._repeated(value, 2) for value in values]
        return operation(*pairs)
