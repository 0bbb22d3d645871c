"""Generate LLVM code for arithmetic on numbers and on pairs of numbers.

The code works on several lanes at once. A lane holds one of several trajectories that are
integrated side by side. With one lane, an operation on a pair takes one instruction instead of two.
`straight_lines` calls this module.
"""

from functools import partial

from llvmlite import ir
from numba.core import cgutils

from impact_damper.kernel.compiling import CONTRACT

FLOAT = ir.DoubleType()
PAIR = ir.VectorType(FLOAT, 2)
INDEX = ir.IntType(32)


class Arithmetic:
    """Writes operations for `width` lanes, and returns their results as LLVM values.

    With one lane a number is a double, and a pair is a vector of two doubles. With more lanes a
    number is a vector with one double per lane, and a pair is a tuple of two such vectors.

    Parameters
    ----------
    builder : llvmlite.ir.IRBuilder
    width : int

    Attributes
    ----------
    type : llvmlite.ir.Type
        Type of a number.
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
        """Return the result of an operation on numbers, or on both numbers of pairs.

        If one value is a pair and another a number, the number is used with both numbers of the
        pair.
        """
        if not any(map(self.is_pair, values)):
            return operation(*values)
        if self.width > 1:
            pairs = [value if self.is_pair(value) else (value, value) for value in values]
            return tuple(map(operation, *pairs))
        pairs = [value if self.is_pair(value) else self._repeated(value, 2) for value in values]
        return operation(*pairs)
