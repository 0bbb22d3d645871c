"""Count the floating-point operations of a function in its source code.

Unlike computing time, this number is the same on every computer. It is called the counted work of
the function. An addition, subtraction, product, quotient or square root counts as one operation. A
sine, logarithm or other elementary function counts as ELEMENTARY operations, an assumed typical
cost. Signs, absolute values, comparisons and subscripts do not count. An operation on a pair of
numbers counts twice. Of two branches of an `if`, the branch with more operations counts, unless the
arguments determine which branch is taken.
"""

import ast
import inspect
import math
import textwrap
from functools import cache

ELEMENTARY = 20
FUNCTIONS = {"cos", "sin", "exp", "log", "atan2", "pow"}


class _Returned(Exception):
    """Raised at a `return` that is certainly reached, since later statements do not count."""


@cache
def operations(function, rounds=1, without=(), **arguments):
    """Return the number of floating-point operations of one call of a function.

    Parameters
    ----------
    function : callable
        A Python function, compiled or not. Operations of the compiled functions that it calls are
        included.
    rounds : int
        Number of times that the body of each `while` loop counts.
    without : tuple of callable
        Compiled functions whose calls do not count.
    **arguments
        Values of arguments that determine the lengths of loops or the choice of branches.

    Raises
    ------
    TypeError
        If an argument is not hashable.
    ValueError
        If the arguments do not determine the length of a `for` loop.
    """
    function = getattr(function, "py_func", function)
    body, changing = _body(function)
    local = set(function.__code__.co_varnames)
    known = {name: value for name, value in function.__globals__.items() if name not in local}
    known |= {name: value for name, value in arguments.items() if name not in changing}
    counter = _Counter(known, rounds, without)
    try:
        for statement in body:
            counter.visit(statement)
    except _Returned:
        pass
    return counter.count


@cache
def _body(function):
    """Return the statements of a function, and the names that it assigns."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    names = [node for node in ast.walk(tree) if isinstance(node, ast.Name)]
    return tree.body, {node.id for node in names if isinstance(node.ctx, ast.Store)}


class _Counter(ast.NodeVisitor):
    """Visits statements and counts their operations in `count`.

    Parameters
    ----------
    known : dict
        Known values keyed by name: the globals of the function, and the arguments that were passed
        to `operations`.
    rounds, without
        Arguments of `operations`.
    pairs : iterable of str
        Names of variables that hold a pair of numbers. Compiled functions use pairs to compute two
        series at once (`kernel.straight_lines`).
    """

    def __init__(self, known, rounds, without, pairs=()):
        self.known, self.rounds, self.without, self.count = known, rounds, without, 0
        self.pairs = set(pairs)

    def value(self, node):
        """Return the value of an expression, or None if it is not known."""
        try:
            return eval(compile(ast.Expression(node), "", "eval"), dict(self.known))
        except Exception:
            return None

    def within(self, statements):
        """Return the number of operations of a block of statements."""
        counter = _Counter(self.known, self.rounds, self.without, self.pairs)
        for statement in statements:
            counter.visit(statement)
        return counter.count

    def is_pair(self, node):
        """Return whether an expression is a pair of numbers."""
        parts = [getattr(node, name, None) for name in ("left", "right", "operand")]
        named = isinstance(node, ast.Name) and node.id in self.pairs
        return isinstance(node, ast.Tuple) or named or any(map(self.is_pair, filter(None, parts)))

    def visit_BinOp(self, node):
        self.count += 2 if self.is_pair(node) else 1
        self.generic_visit(node)

    def visit_Assign(self, node):
        self.generic_visit(node)
        if isinstance(node.targets[0], ast.Name):
            change = self.pairs.add if self.is_pair(node.value) else self.pairs.discard
            change(node.targets[0].id)

    def visit_AugAssign(self, node):
        self.count += 1
        self.generic_visit(node)

    def visit_Subscript(self, node):
        self.visit(node.value)

    def visit_For(self, node):
        values = self.value(node.iter)
        if values is None:
            raise ValueError(f"{ast.unparse(node.iter)}: a loop whose length is not known")
        self.count += len(values) * self.within(node.body)

    def visit_While(self, node):
        self.count += self.rounds * self.within([node.test, *node.body])

    def visit_If(self, node):
        self.visit(node.test)
        taken = self.value(node.test)
        if taken is None:
            parts = [
                [each for each in part if not isinstance(each, ast.Return)]
                for part in (node.body, node.orelse)
            ]
            self.count += max(map(self.within, parts))
            return
        for statement in node.body if taken else node.orelse:
            self.visit(statement)

    def visit_IfExp(self, node):
        self.visit(node.test)
        self.count += max(self.within([node.body]), self.within([node.orelse]))

    def visit_Return(self, node):
        self.generic_visit(node)
        raise _Returned

    def visit_Call(self, node):
        for argument in node.args:
            self.visit(argument)
        called = self.value(node.func)
        if called is math.sqrt:
            self.count += 1
        elif getattr(called, "__module__", None) == "math":
            self.count += ELEMENTARY if called.__name__ in FUNCTIONS else 0
        elif hasattr(called, "py_func") and called not in self.without:
            names = inspect.signature(called.py_func).parameters
            values = map(self.value, node.args)
            known = {
                name: each for name, each in zip(names, values, strict=False) if each is not None
            }
            self.count += operations(called, self.rounds, self.without, **known)
