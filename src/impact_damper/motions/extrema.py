"""The largest absolute value of a polynomial, as of a displacement within a step of the series."""

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.single import polynomial

# Pieces of an interval in each of which a polynomial turns at most once.
PIECES = 8


@kernel
def extremum(c, order, length, start):
    """Return the largest |polynomial| over [0, length], or `start` if that is larger.

    A polynomial exceeds the larger of its two ends by at most length^2/8 times a bound on its
    second derivative; most calls end there. Otherwise the interval is divided into pieces, and
    where a piece turns, Newton's method finds the place.
    """
    low, fall = polynomial(c, order, 0.0)
    high, _ = polynomial(c, order, length)
    excess, power = 0.0, length
    for k in range(2, order + 1):
        power *= length
        excess += 0.125 * k * (k - 1) * abs(c[k]) * power
    best = max(start, max(abs(low), abs(high)))
    if max(abs(low), abs(high)) + excess <= best:
        return best
    for piece in range(1, PIECES + 1):
        t = length * piece / PIECES
        value, slope = polynomial(c, order, t)
        best = max(best, abs(value))
        # it moved outward at the beginning of the piece, or began at the origin, and moves inward
        if slope * fall < 0.0 and value * slope < 0.0:
            best = max(best, abs(turning_value(c, order, t - length / PIECES, t, fall, slope)))
        fall = slope
    return best


@kernel_only
def turning_value(c, order, begin, end, first, last):
    """Return a polynomial where its slope, `first` at begin and `last` at end, is zero."""
    t = begin + (end - begin) * first / (first - last)
    for _ in range(4):
        _, slope = polynomial(c, order, t)
        bend = 0.0
        for k in range(order, 1, -1):
            bend = bend * t + k * (k - 1) * c[k]
        if bend == 0.0:
            break
        t = min(max(t - slope / bend, begin), end)
    value, _ = polynomial(c, order, t)
    return value
