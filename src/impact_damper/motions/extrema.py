"""The largest modulus of a polynomial, such as the displacement within a step of the integrator."""

from impact_damper.kernel.compiling import kernel, kernel_only
from impact_damper.kernel.single import polynomial

# Number of pieces of an interval. In each piece the polynomial is assumed to have at most one
# turning point.
PIECES = 8


@kernel
def extremum(c, order, length, start):
    """Return the largest |polynomial| over [0, length], or `start` if `start` is larger.

    The polynomial exceeds the larger of its values at the two ends by at most length^2/8 times a
    bound on its second derivative. In most calls this bound shows that `start` or an end is
    largest. Otherwise the interval is divided into pieces, and Newton's method locates the turning
    point of a piece.
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
        # The modulus increases at the beginning of the piece and decreases at its end.
        if slope * fall < 0.0 and value * slope < 0.0:
            turn = turning_time(c, order, t - length / PIECES, t, fall, slope)
            best = max(best, abs(polynomial(c, order, turn)[0]))
        fall = slope
    return best


@kernel_only
def turning_time(c, order, begin, end, first, last):
    """Return the turning point of a polynomial between `begin` and `end`.

    `first` and `last` are the slopes at `begin` and `end`.
    """
    t = begin + (end - begin) * first / (first - last)
    for _ in range(4):
        _, slope = polynomial(c, order, t)
        bend = 0.0
        for k in range(order, 1, -1):
            bend = bend * t + k * (k - 1) * c[k]
        if bend == 0.0:
            break
        t = min(max(t - slope / bend, begin), end)
    return t
