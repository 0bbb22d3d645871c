"""Straight lines of arithmetic, compiled without asking for their types.

All numbers are of one type here, or pairs of it, so that LLVM's code can be written at once.
numba's inference of types takes a millisecond for an operation, and the series of a step have
thousands of them.
"""

import ast
import inspect
import textwrap
from contextlib import nullcontext
from functools import partial

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from impact_damper.kernel.compiling import CONTRACT

# Lanes at once, in one register or, where they are narrower, in several.
WIDTH = 8
NUMBER = ir.DoubleType()
PAIR = ir.VectorType(NUMBER, 2)
PLACE = ir.IntType(32)
OPERATIONS = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}


def straight(function):
    """Compile a function that does lines of arithmetic for each lane.

    Parameters
    ----------
    function : callable
        Of one argument or two, pointers to numbers. Its body is a loop `for i in range(lanes)`, of
        a multiple of WIDTH or fewer, over assignments. Their left sides are names, or numbers
        `a[1]` or `a[1 + i]` of an argument, and their right sides sums, differences, products and
        quotients of such, of constants, of tuples of constants at `[i]`, and of `abs` and `max`.
        Two numbers in brackets are a pair, for which each sum, difference, product and quotient is
        made twice; a number beside it counts for both. A pair may be kept by a name, and assigned
        to two of them. With one lane, it is one register.

    Returns
    -------
    intrinsic
        To be called in a kernel. Its attribute `py_func` is the function.
    """
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    names = [argument.arg for argument in tree.args.args]
    loop = tree.body[0]
    lanes = loop.iter.args[0].value
    width = min(lanes, WIDTH)

    def generate(context, builder, signature, arguments):
        arrays = dict(zip(names, arguments, strict=True))
        count, step = (context.get_constant(types.intp, n) for n in (lanes // width, width))
        # A loop of one round would move stores behind its end.
        with cgutils.for_range(builder, count) if lanes > width else nullcontext() as turn:
            first = builder.mul(turn.index, step) if turn else None
            lines = _Lines(builder, arrays, first, width)
            for statement in loop.body:
                lines.visit(statement)
        return context.get_dummy_value()

    # Numba reads off the signature how many arguments there are.
    def of_one(typing, a):
        return types.void(a), generate

    def of_two(typing, a, d):
        return types.void(a, d), generate

    compiled = intrinsic(of_one if len(names) == 1 else of_two)
    compiled.py_func = function
    return compiled


def is_product(node):
    """Whether an expression is a product."""
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)


def repeated(builder, number, count):
    """A vector of a number so many times."""
    vector = ir.Constant(ir.VectorType(NUMBER, count), ir.Undefined)
    vector = builder.insert_element(vector, number, ir.Constant(PLACE, 0))
    zeros = ir.Constant(ir.VectorType(PLACE, count), [0] * count)
    return builder.shuffle_vector(vector, vector, zeros)


class _Lines(ast.NodeVisitor):
    """Writes assignments for some lanes from the first on; with one lane of numbers and pairs."""

    def __init__(self, builder, arrays, first, width):
        self.builder, self.arrays, self.first, self.width = builder, arrays, first, width
        self.type = NUMBER if width == 1 else ir.VectorType(NUMBER, width)
        self.values = {}

    def constant(self, number):
        """A number in all lanes."""
        return ir.Constant(self.type, number if self.width == 1 else [number] * self.width)

    def place(self, node):
        """Pointer to a number of an array, and whether each lane has its own."""
        index, own = node.slice, isinstance(node.slice, ast.BinOp)
        number = ir.Constant(ir.IntType(64), (index.left if own else index).value)
        if own and self.first is not None:
            number = self.builder.add(number, self.first)
        return self.builder.gep(self.arrays[node.value.id], [number], inbounds=True), own

    def visit_Assign(self, node):
        self.store(node.targets[0], self.visit(node.value))

    def visit_AugAssign(self, node):
        self.store(node.target, self.visit(ast.BinOp(node.target, node.op, node.value)))

    def store(self, target, value):
        if isinstance(target, ast.Tuple):
            for place, each in enumerate(target.elts):
                self.store(each, self.part(value, place))
            return
        if isinstance(target, ast.Name):
            self.values[target.id] = value
            return
        pointer, _ = self.place(target)
        self.builder.store(value, self.builder.bitcast(pointer, self.type.as_pointer()), align=8)

    def visit_Subscript(self, node):
        if isinstance(node.value, ast.Tuple):
            return ir.Constant(self.type, list(map(float, ast.literal_eval(node.value))))
        pointer, own = self.place(node)
        if own:
            pointer = self.builder.bitcast(pointer, self.type.as_pointer())
            return self.builder.load(pointer, align=8)
        number = self.builder.load(pointer, align=8)
        if self.width == 1:
            return number
        return repeated(self.builder, number, self.width)

    def visit_Name(self, node):
        return self.values[node.id]

    def visit_Constant(self, node):
        return self.constant(float(node.value))

    def visit_UnaryOp(self, node):
        return self.negative(self.visit(node.operand))

    def visit_Tuple(self, node):
        parts = tuple(map(self.visit, node.elts))
        if self.width > 1:
            return parts
        pair = ir.Constant(PAIR, ir.Undefined)
        for place, each in enumerate(parts):
            pair = self.builder.insert_element(pair, each, ir.Constant(PLACE, place))
        return pair

    def part(self, value, place):
        """A number of a pair."""
        if self.width > 1:
            return value[place]
        return self.builder.extract_element(value, ir.Constant(PLACE, place))

    def visit_BinOp(self, node):
        """A product that is added is fused with the sum: that on the right, if there are two."""
        kind, left, right = type(node.op), node.left, node.right
        if kind in (ast.Add, ast.Sub) and is_product(right):
            first = self.visit(right.left)
            first = self.negative(first) if kind is ast.Sub else first
            return self.each(self.fused, first, self.visit(right.right), self.visit(left))
        if kind in (ast.Add, ast.Sub) and is_product(left):
            last = self.visit(right)
            last = self.negative(last) if kind is ast.Sub else last
            return self.each(self.fused, self.visit(left.left), self.visit(left.right), last)
        operation = partial(getattr(self.builder, OPERATIONS[kind]), flags=CONTRACT)
        return self.each(operation, self.visit(left), self.visit(right))

    def negative(self, value):
        """A number or pair with the other sign."""
        return self.each(partial(self.builder.fneg, flags=CONTRACT), value)

    def fused(self, *values):
        """First times second plus third, rounded once where the machine can."""
        kind = values[0].type
        name = "llvm.fmuladd." + (f"v{kind.count}f64" if isinstance(kind, ir.VectorType) else "f64")
        signature = ir.FunctionType(kind, [kind] * 3)
        function = cgutils.get_or_insert_function(self.builder.module, signature, name)
        return self.builder.call(function, values)

    def each(self, operation, *values):
        """An operation on numbers, or on the numbers of pairs and those beside them."""
        if self.width > 1:
            if not any(isinstance(value, tuple) for value in values):
                return operation(*values)
            values = [value if isinstance(value, tuple) else (value, value) for value in values]
            return tuple(map(operation, *values))
        if any(value.type == PAIR for value in values):
            values = [
                repeated(self.builder, each, 2) if each.type == NUMBER else each for each in values
            ]
        return operation(*values)

    def visit_Call(self, node):
        values = [self.visit(argument) for argument in node.args]
        if node.func.id == "abs":
            name = "llvm.fabs.f64" if self.width == 1 else f"llvm.fabs.v{self.width}f64"
            signature = ir.FunctionType(self.type, [self.type])
            function = cgutils.get_or_insert_function(self.builder.module, signature, name)
            return self.builder.call(function, values)
        larger = self.builder.fcmp_ordered(">", *values)
        return self.builder.select(larger, *values)
