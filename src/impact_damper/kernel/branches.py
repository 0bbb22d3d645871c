"""Compile templates without numba's front end, which would take most of the compilation time.

A template is a Python function of the integration step (folder `templates`). Its arguments are
numbers and pointers to float64. It consists of assignments, calls, `if`, `while`, `return`, and
`for` loops over `range(count)` with a constant count.
"""

import ast
import builtins
import inspect
import math
import operator
from functools import cache, partial, reduce
from pathlib import Path

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from impact_damper.kernel.compiling import CONTRACT

FLOAT, INTEGER, TRUTH = ir.DoubleType(), ir.IntType(64), ir.IntType(1)
# For each operator: Python function, LLVM instruction for floats, LLVM instruction for integers.
OPERATORS = {
    ast.Add: (operator.add, "fadd", "add"),
    ast.Sub: (operator.sub, "fsub", "sub"),
    ast.Mult: (operator.mul, "fmul", "mul"),
    ast.Div: (operator.truediv, "fdiv", None),
    ast.FloorDiv: (operator.floordiv, None, None),
    ast.Mod: (operator.mod, None, "srem"),
    ast.Pow: (operator.pow, None, None),
    ast.LShift: (operator.lshift, None, "shl"),
    ast.RShift: (operator.rshift, None, "ashr"),
}
SIGNS = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">=", ast.Eq: "==", ast.NotEq: "!="}
INTRINSICS = {math.sqrt: "sqrt", math.sin: "sin", math.cos: "cos", np.floor: "floor", abs: "fabs"}


@cache
def _definitions(file):
    found = {}
    for node in ast.walk(ast.parse(Path(file).read_text())):
        if isinstance(node, ast.FunctionDef):
            found[min(each.lineno for each in (node, *node.decorator_list))] = node
    return found


def definition(function):
    """Return the syntax tree of a function."""
    return _definitions(function.__code__.co_filename)[function.__code__.co_firstlineno]


def bits(x):
    """Return a float's bits as an integer. For x > 0 this is about 2^52 (1023 + log2(x))."""
    return int(np.float64(x).view(np.int64))


def number(x):
    """Return the float whose bits are the integer x."""
    return float(np.int64(x).view(np.float64))


def template(function, caller):
    """Return a function that executes the template `function`, and that kernels can call.

    For example, a module sets `forcing = template(forcing, call_forcing)`. The Python function
    `caller`, here call_forcing, only calls forcing(a). `compiling.compiled` can compile `caller`.
    """

    def generate(context, builder, signature, arguments):
        builder.call(_compiled(builder.module, function, arguments), arguments)
        return context.get_dummy_value()

    # numba reads the number of the template's arguments from the signature of these functions.
    def of_one(typing, a):
        return types.void(a), generate

    def of_two(typing, a, d):
        return types.void(a, d), generate

    made = intrinsic(of_one if len(inspect.signature(function).parameters) == 1 else of_two)
    made.template, made.py_func = function, caller
    return made


def _is_llvm(value):
    return isinstance(value, ir.Value)


def _compiled(module, function, arguments):
    # Arguments are LLVM values, or Python numbers, which become constants in the LLVM function.
    name = f"{function.__module__}.{function.__name__}"
    name = ".".join([name, *(str(each) for each in arguments if not _is_llvm(each))])
    if name in module.globals:
        return module.globals[name]
    kind = ir.FunctionType(ir.VoidType(), [each.type for each in arguments if _is_llvm(each)])
    made = ir.Function(module, kind, name)
    made.linkage = "linkonce_odr"
    builder, given = ir.IRBuilder(made.append_basic_block()), iter(made.args)
    values = [next(given) if _is_llvm(each) else each for each in arguments]
    if hasattr(function, "write"):
        function.write(function, builder, values)
    else:
        Body(builder, function).expand(values)
    builder.ret_void()
    return made


class Body(ast.NodeVisitor):
    """Writes the LLVM code of a template. Values known at compilation stay Python objects."""

    def __init__(self, builder, function):
        self.builder, self.function = builder, function
        self.tree = definition(function)
        # `values` has the value of each name that is assigned once. `memory` has a pointer for each
        # other name, and `returned` has a pointer for each result.
        self.values, self.memory, self.returned = {}, {}, []

    def expand(self, arguments):
        """Write the code of the template for given arguments. Return the template's result."""
        self.end = self.builder.append_basic_block()
        names = [each.arg for each in self.tree.args.args]
        nodes = [each for each in ast.walk(self.tree) if isinstance(each, ast.Name)]
        stored = names + [each.id for each in nodes if isinstance(each.ctx, ast.Store)]
        self.once = {name for name in stored if stored.count(name) == 1}
        left = len(names) - len(arguments)
        defaults = self.function.__defaults__[-left:] if left else ()
        for name, value in zip(names, [*arguments, *defaults], strict=True):
            self.set(name, value)
        self.run(self.tree.body)
        if not self.builder.block.is_terminated:
            self.builder.branch(self.end)
        self.builder.position_at_end(self.end)
        values = tuple(map(self.builder.load, self.returned))
        return values[0] if len(values) == 1 else values

    def run(self, statements):
        """Write the code of statements, up to the first `return`."""
        for statement in statements:
            if not self.builder.block.is_terminated:
                self.visit(statement)

    def set(self, name, value):
        """Assign a value to a name."""
        if name in self.once:
            self.values[name] = value
            return
        if name not in self.memory:
            self.memory[name] = cgutils.alloca_once(self.builder, self.llvm(value).type)
        self.builder.store(self.llvm(value, self.memory[name].type.pointee), self.memory[name])

    def llvm(self, value, kind=None):
        """Return a value as an LLVM value. If `kind` is FLOAT, an integer becomes a float."""
        if _is_llvm(value):
            converted = value.type == INTEGER and kind == FLOAT
            return self.builder.sitofp(value, FLOAT) if converted else value
        if isinstance(value, (bool, np.bool_)):
            return ir.Constant(TRUTH, int(value))
        return ir.Constant(FLOAT if kind == FLOAT or isinstance(value, float) else INTEGER, value)

    def alike(self, *values):
        """Return numbers as LLVM values. If one of them is a float, all become floats."""
        kinds = [self.llvm(each).type for each in values]
        return [self.llvm(each, FLOAT if FLOAT in kinds else None) for each in values]

    def pointer(self, node):
        """Return the pointer to an array entry, such as a[3]."""
        index = self.llvm(self.visit(node.slice))
        return self.builder.gep(self.visit(node.value), [index], inbounds=True)

    def generic_visit(self, node):
        file = self.function.__code__.co_filename
        raise SyntaxError(f"{file}, line {node.lineno}: unknown in templates: {ast.unparse(node)}")

    def visit_Expr(self, node):
        self.visit(node.value)

    def visit_Assign(self, node):
        value = self.visit(node.value)
        for target in node.targets:
            self.store(target, value)

    def visit_AugAssign(self, node):
        value = ast.copy_location(ast.BinOp(node.target, node.op, node.value), node)
        self.store(node.target, self.visit(value))

    def store(self, target, value):
        """Assign a value to a name, to an array entry, or to a tuple of such targets."""
        if isinstance(target, ast.Tuple):
            for each, part in zip(target.elts, value, strict=True):
                self.store(each, part)
        elif isinstance(target, ast.Name):
            self.set(target.id, value)
        else:
            self.builder.store(self.llvm(value, FLOAT), self.pointer(target))

    def visit_Return(self, node):
        value = self.visit(node.value)
        values = value if isinstance(value, tuple) else (value,)
        if not self.returned:
            kinds = [self.llvm(each).type for each in values]
            self.returned = [cgutils.alloca_once(self.builder, kind) for kind in kinds]
        for each, place in zip(values, self.returned, strict=True):
            self.builder.store(self.llvm(each, place.type.pointee), place)
        self.builder.branch(self.end)

    def visit_If(self, node):
        test = self.visit(node.test)
        if not _is_llvm(test):
            self.run(node.body if test else node.orelse)
            return
        with self.builder.if_else(test) as (then, otherwise):
            with then:
                self.run(node.body)
            with otherwise:
                self.run(node.orelse)

    def visit_While(self, node):
        test, body, after = (self.builder.append_basic_block() for _ in range(3))
        self.builder.branch(test)
        self.builder.position_at_end(test)
        self.builder.cbranch(self.visit(node.test), body, after)
        self.builder.position_at_end(body)
        self.run(node.body)
        self.builder.branch(test)
        self.builder.position_at_end(after)

    def visit_For(self, node):
        """Unroll the loop. But a loop over `i` with several rounds becomes an LLVM loop."""
        count, counter = self.visit(node.iter.args[0]), node.target.id
        if counter == "i" and count > 1:
            with cgutils.for_range(self.builder, ir.Constant(INTEGER, count)) as loop:
                self.values[counter] = loop.index
                self.run(node.body)
            return
        for k in range(count):
            self.values[counter] = k
            self.run(node.body)

    def visit_Name(self, node):
        if node.id in self.memory:
            return self.builder.load(self.memory[node.id])
        known = self.values if node.id in self.values else self.function.__globals__
        return known[node.id] if node.id in known else getattr(builtins, node.id)

    def visit_Constant(self, node):
        return node.value

    def visit_Attribute(self, node):
        return getattr(self.visit(node.value), node.attr)

    def visit_Tuple(self, node):
        return tuple(map(self.visit, node.elts))

    def visit_Subscript(self, node):
        value = self.visit(node.value)
        if isinstance(value, tuple):
            return value[self.visit(node.slice)]
        return self.builder.load(self.pointer(node))

    def visit_IfExp(self, node):
        test = self.visit(node.test)
        if not _is_llvm(test):
            return self.visit(node.body if test else node.orelse)
        return self.builder.select(test, *self.alike(*map(self.visit, (node.body, node.orelse))))

    def visit_BoolOp(self, node):
        decisive, found = isinstance(node.op, ast.Or), []
        for each in node.values:
            value = self.visit(each)
            if _is_llvm(value):
                found.append(value)
            elif value == decisive:
                return decisive
        combine = self.builder.or_ if decisive else self.builder.and_
        return reduce(combine, found) if found else not decisive

    def visit_Compare(self, node):
        terms = [self.visit(each) for each in (node.left, *node.comparators)]
        signs = [SIGNS[type(each)] for each in node.ops]
        return reduce(self.builder.and_, map(self.compared, signs, terms, terms[1:]))

    def compared(self, sign, *pair):
        """Return the result of comparing two numbers. `sign` is the operator, such as "<"."""
        pair = self.alike(*pair)
        if pair[0].type != FLOAT:
            return self.builder.icmp_signed(sign, *pair)
        compare = self.builder.fcmp_unordered if sign == "!=" else self.builder.fcmp_ordered
        return compare(sign, *pair)

    def visit_UnaryOp(self, node):
        value = self.visit(node.operand)
        if isinstance(node.op, ast.Not):
            return self.builder.not_(value) if _is_llvm(value) else not value
        return self.builder.fneg(value, flags=CONTRACT) if _is_llvm(value) else -value

    def visit_BinOp(self, node):
        left, right = self.visit(node.left), self.visit(node.right)
        function, real, whole = OPERATORS[type(node.op)]
        if not (_is_llvm(left) or _is_llvm(right)):
            return function(left, right)
        pair = self.alike(left, right)
        if pair[0].type == FLOAT:
            return getattr(self.builder, real)(*pair, flags=CONTRACT)
        return getattr(self.builder, whole)(*pair)

    def extreme(self, sign, found, other):
        """Return the smaller (sign "<") or larger (sign ">") of the numbers `found` and `other`."""
        return self.builder.select(self.compared(sign, other, found), other, found)

    def visit_Call(self, node):
        function, arguments = self.visit(node.func), [self.visit(each) for each in node.args]
        varying = [each for each in arguments if _is_llvm(each)]
        if not varying:
            return function(*arguments)
        if function in (min, max):
            sign = "<" if function is min else ">"
            return reduce(partial(self.extreme, sign), self.alike(*arguments))
        if function in INTRINSICS:
            name = f"llvm.{INTRINSICS[function]}"
            return self.builder.call(self.builder.module.declare_intrinsic(name, [FLOAT]), varying)
        if function in (bits, number):
            return self.builder.bitcast(*varying, INTEGER if function is bits else FLOAT)
        if function is np.int64:
            return self.builder.fptosi(*varying, INTEGER)
        function = getattr(function, "template", getattr(function, "py_func", function))
        returns = any(isinstance(each, ast.Return) for each in ast.walk(definition(function)))
        if returns or not all(each.type.is_pointer for each in varying):
            return Body(self.builder, function).expand(arguments)
        return self.builder.call(_compiled(self.builder.module, function, arguments), varying)
