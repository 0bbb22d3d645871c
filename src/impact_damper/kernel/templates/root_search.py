"""Search for a root of the gap within a step.

An event is a root of the *gap*: the distance to a wall in flight, the penetration in contact. Each
search is in one of five modes, which it keeps in the row MODE.

    MARCH     several roots are possible. A bound on the second derivative of the gap gives a time
              within which the gap cannot vanish; the search advances by such times, so that it
              never passes the first root
    BRACKET   at most one root is possible. A safeguarded iteration of third order finds it
    ENDING    the search has marched to the end of the step without a root
    MET       the root has been found
    MISSED    there is certainly no root in the step

The templates `contact` and `release` search with these kernels. This file is a template (see
`step`): all templates are compiled together as one module.
"""

import math

from impact_damper.kernel.compiling import kernel_only

LANES: int

ROUNDING = 2.0**-50
# Stop the iteration for a root once (move / time in which the gap bends)^3 is below LAST_MOVE times
# the tolerance: the cube is the size of the term that is neglected in the speed.
LAST_MOVE = 0.01
MARCH, BRACKET, ENDING, MET, MISSED = 0.0, 1.0, 2.0, 3.0, 4.0
TINY = 1e-300
FAR = 1e200


@kernel_only
def safe_advance(gap, closing, bound):
    """Return a time within which the gap cannot vanish.

    It is the first root of gap - closing t - bound t^2/2, where `closing` is the speed at which the
    gap closes and `bound` an upper bound on the modulus of its second derivative.
    """
    gap = max(gap, 0.0)
    root = math.sqrt(closing * closing + 2.0 * bound * gap)
    above = 2.0 * gap if closing > 0.0 else root - closing
    below = closing + root if closing > 0.0 else bound + TINY
    return above / below


@kernel_only
def march_step(t, f, closing, ahead, length, fine):
    """Return the next time and mode of a search in mode MARCH.

    f is the gap at t; from t on it stays positive for the time `ahead`. The root is at t if f is
    below the rounding error `fine` and the gap closes, or if `ahead` is too short to advance t.
    """
    met = closing and (f <= fine or t + ahead == t)
    ends = not t + ahead < length
    following = t if met else (length if ends else t + ahead)
    return following, MET if met else (ENDING if ends else MARCH)


@kernel_only
def chebyshev(first, bend):
    """Return a step of Chebyshev's method, which is of third order.

    `first` is the step of Newton's method, and `bend` the second derivative over the first.
    """
    return first * (1.0 - 0.5 * bend * first)


@kernel_only
def is_last_move(a, i, move, rate):
    """Return whether a move is so short that the terms it neglects are far below the tolerance.

    `rate` is the inverse of the time in which the gap bends.
    """
    turn = max(rate, 2.0 / a[LENGTH + i]) * move
    return abs(turn * turn * turn) <= max(LAST_MOVE * a[TOLERANCE + i], ROUNDING)


@kernel_only
def bracketed_step(a, i, t, f, first, bend, rate, fine):
    """Return the next move and mode of a search in mode BRACKET: one safeguarded iteration.

    f is the gap at t, positive at LOW and not positive at HIGH, with one root between them. HIGH is
    FAR while no such time is known: then at most one root lies between LOW and the end of the step.
    A move that would leave the bracket is replaced by bisection.

    Parameters
    ----------
    first, bend : float
        As in `chebyshev`, or another first guess and the bend that this guess neglects.
    rate : float
        Lower limit of the rate that `is_last_move` receives.
    fine : float
        Rounding error of the gap.
    """
    low = a[LOW + i] = t if f > 0.0 else a[LOW + i]
    high = a[HIGH + i] = a[HIGH + i] if f > 0.0 else t
    length = a[LENGTH + i]
    move = chebyshev(first, bend)
    inside = low < t + move and t + move < high
    past = high == FAR and not t + move < length
    last = inside and not past and is_last_move(a, i, move, max(rate, abs(bend)))
    if abs(f) <= fine:
        return 0.0, MET
    if f > 0.0 and not t < length:
        return 0.0, MISSED
    inner = move if inside else 0.5 * (low + min(high, length)) - t
    step = length - t if past else inner
    # The search also ends where the move is below the rounding of t, or is NaN.
    moved = t + step > t or t + step < t
    return step, MET if last or not moved else BRACKET


@kernel_only
def store_end(a, i, row, end, move, going):
    """Store value and slope after a move in the rows from `end` on, if the search is `going` on.

    They are extrapolated from value, slope, curve and jerk before the move: the four rows from
    `row` on.
    """
    value, slope = a[row + i], a[row + LANES + i]
    curve, jerk = a[row + 2 * LANES + i], a[row + 3 * LANES + i]
    value += move * (slope + move * (0.5 * curve + move * (jerk / 6.0)))
    slope += move * (curve + move * (0.5 * jerk))
    a[end + i] = value if going else a[end + i]
    a[end + LANES + i] = slope if going else a[end + LANES + i]


@kernel_only
def store_search(a, i, mode, t, move):
    """Store time, mode and Z1 of a search after a move; return 1 if it goes on, else 0."""
    going = a[MODE + i] <= ENDING
    a[T + i] = t
    a[MODE + i] = mode
    store_end(a, i, Z1, END_Z1, move, going)
    return 1 if mode <= ENDING else 0
