"""Compile arithmetic without branches ("straight lines"), bypassing numba's type inference.

A Taylor series of a step has thousands of operations, and numba's type inference takes a
millisecond for each. Each lane holds one of several trajectories, and all lanes execute the same
lines. With one lane an operation on a pair of numbers takes one instruction, not two.
"""

import ast
from contextlib import nullcontext
from functools import cache, partial
from pathlib import Path

from llvmlite import ir
from numba.core import cgutils

from impact_damper.kernel.compiling import CONTRACT

# Number of lanes in a vector. Eight doubles fill one register of 512 bits or several narrower ones.
WIDTH = 8
FLOAT = ir.DoubleType()
PAIR = ir.VectorType(FLOAT, 2)
INDEX, OFFSET = ir.IntType(32), ir.IntType(64)
OPERATIONS = {ast.Add: "fadd", ast.Sub: "fsub", ast.Mult: "fmul", ast.Div: "fdiv"}


class NotStraightError(SyntaxError):
    """`straight` cannot compile a line; the message names the file and the number of the line."""


def straight(function):
    """Decorate a function that executes the same lines of arithmetic for each lane.

    The function takes one or two pointers to float64. Its body is a loop `for i in range(lanes)`.
    The number of lanes is at most WIDTH, or a multiple of WIDTH. The loop has only assignments:

    - The left side of `=` or `+=` is a name, `a[1 + i]`, or, with one lane, `a[1]`.
    - The right side consists of names, constants, `a[1 + i]`, `a[1]` (the same for all lanes),
      `(1.0, 2.0)[i]` (one constant per lane), `+`, `-`, `*`, `/`, `abs(x)`, and `max(x, y)`,
      which means `x if x > y else y`.
    - `(x, y)` is a pair. A name can hold a pair, and `x, y = ...` unpacks a pair. Operators act on
      both values of a pair, and combine a float with both values.

    Templates can call the function (`branches.template`). A line of another form raises
    NotStraightError when a template that calls the function is compiled.
    """
    function.is_straight = True
    return function


@cache
def _definitions(file):
    """Return the syntax trees of the functions of a file, by the number of their first line."""
    nodes = ast.walk(ast.parse(Path(file).read_text()))
    functions = [each for each in nodes if isinstance(each, ast.FunctionDef)]
    return {
        min([each.lineno, *(d.lineno for d in each.decorator_list)]): each for each in functions
    }


def definition(function):
    """Return the syntax tree of a function."""
    code = function.__code__
    return _definitions(code.co_filename)[code.co_firstlineno]


def write(function, builder, pointers):
    """Write the LLVM code of a `straight` function, with pointers to its arrays."""
    tree = definition(function)
    lines = _Lines(function.__code__.co_filename, builder)
    (loop,) = tree.body
    lanes = loop.iter.args[0].value
    lines.arrays = dict(zip([each.arg for each in tree.args.args], pointers, strict=True))
    lines.counter = loop.target.id
    lines.lanes, lines.width = lanes, min(lanes, WIDTH)
    lines.arithmetic = Arithmetic(builder, lines.width)
    rounds, step = (ir.Constant(OFFSET, count) for count in (lanes // lines.width, lines.width))
    # One vector for all lanes needs no loop. LLVM would move the stores of a loop behind its end.
    with cgutils.for_range(builder, rounds) if lanes > WIDTH else nullcontext() as turn:
        lines.first = builder.mul(turn.index, step) if turn else None
        for statement in loop.body:
            lines.visit(statement)


def is_product(node):
    """Return whether an expression is a product."""
    return isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult)


class _Lines(ast.NodeVisitor):
    """Writes the LLVM code of assignments for `width` lanes, beginning with lane `first`."""

    def __init__(self, file, builder):
        self.file, self.builder = file, builder
        self.values = {}

    def refuse(self, node, reason):
        """Raise NotStraightError with the line of a node and the reason."""
        raise NotStraightError(f"{self.file}, line {node.lineno}: {reason}: {ast.unparse(node)}")

    def generic_visit(self, node):
        self.refuse(node, "cannot be compiled as straight lines")

    def visit_Assign(self, node):
        self.store(node.targets[0], self.visit(node.value))

    def visit_AugAssign(self, node):
        value = ast.copy_location(ast.BinOp(node.target, node.op, node.value), node)
        self.store(node.target, self.visit(value))

    def store(self, target, value):
        match target:
            case ast.Tuple(elts=[first, second]):
                for number, each in enumerate((first, second)):
                    self.store(each, self.arithmetic.part(value, number))
            case ast.Name(name):
                self.values[name] = value
            case ast.Subscript():
                pointer, _ = self.element(target)
                pointer = self.builder.bitcast(pointer, self.arithmetic.type.as_pointer())
                self.builder.store(value, pointer, align=8)
            case _:
                self.refuse(target, "cannot be assigned to")

    def element(self, node):
        """Return the pointer to `a[1]` or `a[1 + i]`, and whether the index contains i."""
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
        number = ir.Constant(OFFSET, offset)
        if own and self.first is not None:
            number = self.builder.add(number, self.first)
        pointer = self.builder.gep(self.arrays[array], [number], inbounds=True)
        return pointer, own

    def visit_Subscript(self, node):
        if isinstance(node.value, ast.Tuple):
            return self.constants(node)
        pointer, own = self.element(node)
        if own:
            pointer = self.builder.bitcast(pointer, self.arithmetic.type.as_pointer())
            return self.builder.load(pointer, align=8)
        number = self.builder.load(pointer, align=8)
        return self.arithmetic.in_all_lanes(number)

    def constants(self, node):
        """Return a number that has its own constant in each lane."""
        return ir.Constant(self.arithmetic.type, [self.literal(each) for each in node.value.elts])

    def literal(self, node):
        """Return the value of a number in the source, which may have a minus sign."""
        match node:
            case ast.UnaryOp(ast.USub(), operand):
                return -self.literal(operand)
            case ast.Constant(value) if type(value) in (int, float):
                return float(value)
        self.refuse(node, "not a number")

    def visit_Name(self, node):
        return self.values[node.id]

    def visit_Constant(self, node):
        return self.arithmetic.constant(self.literal(node))

    def visit_UnaryOp(self, node):
        return self.arithmetic.negative(self.visit(node.operand))

    def visit_Tuple(self, node):
        return self.arithmetic.pair(*map(self.visit, node.elts))

    def visit_BinOp(self, node):
        """Return a sum, difference, product or quotient.

        a*b + c becomes fmuladd(a, b, c). If both terms are products, the right product is fused.
        """
        kind, left, right = type(node.op), node.left, node.right
        if kind not in OPERATIONS:
            self.refuse(node, "an unknown operator")
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
        called = {"abs": self.arithmetic.modulus, "max": self.arithmetic.larger}
        if node.func.id not in called:
            self.refuse(node, "neither abs nor max")
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
        """Return a constant number, the same in all lanes."""
        return ir.Constant(self.type, value if self.width == 1 else [value] * self.width)

    def in_all_lanes(self, value):
        """Return the number whose value is the double `value` in all lanes."""
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
        """Return the number at the place 0 or 1 of a pair."""
        if self.width > 1:
            return pair[place]
        return self.builder.extract_element(pair, ir.Constant(INDEX, place))

    def combined(self, instruction, *values):
        """Return the result of an LLVM instruction, such as "fadd", on numbers or pairs."""
        return self._each(partial(getattr(self.builder, instruction), flags=CONTRACT), *values)

    def negative(self, value):
        """Return a number or pair with the opposite sign."""
        return self.combined("fneg", value)

    def fused(self, first, second, third):
        """Return first * second + third, rounded once if the processor has such an instruction."""
        return self._each(partial(self._intrinsic, "llvm.fmuladd"), first, second, third)

    def modulus(self, number):
        """Return the modulus of a number."""
        return self._intrinsic("llvm.fabs", number)

    def larger(self, first, second):
        """Return the larger of two numbers; the second one if they cannot be compared (NaN)."""
        return self.builder.select(self.builder.fcmp_ordered(">", first, second), first, second)

    def _repeated(self, value, count):
        """Return a vector that holds a double `count` times."""
        vector = ir.Constant(ir.VectorType(FLOAT, count), ir.Undefined)
        vector = self.builder.insert_element(vector, value, ir.Constant(INDEX, 0))
        zeros = ir.Constant(ir.VectorType(INDEX, count), [0] * count)
        return self.builder.shuffle_vector(vector, vector, zeros)

    def _intrinsic(self, name, *values):
        """Return the result of an LLVM intrinsic for values of one type."""
        kind = values[0].type
        suffix = f"v{kind.count}f64" if isinstance(kind, ir.VectorType) else "f64"
        signature = ir.FunctionType(kind, [kind] * len(values))
        function = cgutils.get_or_insert_function(
            self.builder.module, signature, f"{name}.{suffix}"
        )
        return self.builder.call(function, values)

    def _each(self, operation, *values):
        """Return the result of an operation on numbers, or on both numbers of pairs."""
        if not any(map(self.is_pair, values)):
            return operation(*values)
        if self.width > 1:
            pairs = [value if self.is_pair(value) else (value, value) for value in values]
            return tuple(map(operation, *pairs))
        pairs = [value if self.is_pair(value) else self._repeated(value, 2) for value in values]
        return operation(*pairs)
