"""Template (see `step`): search for the first root of an event function f(t) within a step.

In flight f is the distance of the loose mass to a wall. A contact begins at the root of f. In
contact f is q + LAG q', and q is the depth. The contact ends at the root of f. Values of MODE:

    MARCH     several roots are possible. The search advances by times within which f, because of a
              bound on |f''|, cannot reach zero. So the search never passes the first root.
    BRACKET   at most one root is possible. Chebyshev's method finds it, secured by bisection.
    ENDING    the search has reached the end of the step without a root.
    MET       the root has been found.
    MISSED    no root is known: the search has found none, or it has not yet begun.
    MET_DEEP  the root has been found. There a contact begins at |Z2| > d0 (`across.find_return`).
    TURNED    before the root, the loose mass stops or begins to slide (`friction.find_turn`).
"""

# Rounding error of an event function, relative to its largest term: 4 units in the last place.
ROUNDING = 2.0**-50
# A search in mode BRACKET ends when the root's estimated error is LAST_MOVE * tolerance or less.
LAST_MOVE = 0.01
MARCH, BRACKET, ENDING, MET, MISSED, MET_DEEP, TURNED = 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0
# TINY prevents divisions by zero. FAR replaces infinity, because 0 times infinity is NaN.
TINY = 1e-300
FAR = 1e200


def safe_advance(f, closing, bound):
    """Return a time within which an event function f(t) cannot fall to zero.

    `f` is the function's value now, `closing` is -f' now, and |f''| is at most `bound` at any time.
    The returned time is the first root t of the polynomial f - closing t - bound t^2/2.
    """
    f = max(f, 0.0)
    root = math.sqrt(closing * closing + 2.0 * bound * f)
    above = 2.0 * f if closing > 0.0 else root - closing
    below = closing + root if closing > 0.0 else bound + TINY
    return above / below


def march_step(t, f, closing, ahead, length, fine):
    """Return two numbers: the next time and the next mode of a search in mode MARCH.

    `f` is the value of the event function at the time t, and `fine` its rounding error. `closing`
    is true if the function decreases at t. The function has no root between t and t + `ahead`. The
    search ends at the time `length`. If the function decreases at t, then t is the root in two
    cases: `f` is at most `fine`, or t + `ahead` is rounded to t.
    """
    met = closing and (f <= fine or t + ahead == t)
    ends = not t + ahead < length
    following = t if met else (length if ends else t + ahead)
    return following, MET if met else (ENDING if ends else MARCH)


def chebyshev(first, bend):
    """Return a step of Chebyshev's third-order method for f. `first` is -f/f', `bend` is f''/f'."""
    return first * (1.0 - 0.5 * bend * first)


def is_last_move(a, i, move, rate):
    """Return whether the root's estimated error is small enough to end a search after a `move`.

    The estimate is |r move|^3, a number without a unit. `move` is a change of the time, and r is
    the larger of 2/LENGTH and `rate`. f is the event function. In flight `rate` is |f''/f'|. In
    contact `rate` is the larger of |(f'' + n^2 f)/f'| and n, the contact's natural frequency.
    """
    turn = max(rate, 2.0 / a[LENGTH + i]) * move
    return abs(turn * turn * turn) <= max(LAST_MOVE * a[TOLERANCE + i], ROUNDING)


def bracketed_step(a, i, t, f, first, bend, rate, fine):
    """Return two numbers: the next move and the next mode of a search in mode BRACKET.

    `f` is the value of the event function at the time t, and `fine` its rounding error. A move is a
    change of t. f > 0 at the time LOW. HIGH is a time at which f <= 0, or the number FAR = 1e200 if
    no such time has been found. At most one root lies between LOW and HIGH in the step. A move that
    would leave the interval from LOW to HIGH is replaced by bisection.

    In flight `first` is Newton's move -f/f', `bend` is f''/f', and `rate` is 0. In contact `rate`
    is the natural frequency n of the contact. `first` then estimates the move by the
    assumption f'' = -n^2 f, and `bend` is (f'' + n^2 f)/f'.
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
    # The search also ends if the move is too short to change t, or if the move is NaN.
    moved = t + step > t or t + step < t
    return step, MET if last or not moved else BRACKET


def store_end(a, i, row, end, move, going):
    """Extrapolate a function by the time `move`. Store the value and the slope at the new time.

    The four rows from `row` on hold the function and its first three derivatives before the move.
    The two rows from `end` on receive the value and the slope, if `going` is true.
    """
    value, slope = a[row + i], a[row + LANES + i]
    curve, jerk = a[row + 2 * LANES + i], a[row + 3 * LANES + i]
    value += move * (slope + move * (0.5 * curve + move * (jerk / 6.0)))
    slope += move * (curve + move * (0.5 * jerk))
    a[end + i] = value if going else a[end + i]
    a[end + LANES + i] = slope if going else a[end + LANES + i]


def store_search(a, i, mode, t, move):
    """Store t and `mode`. Also store Z1 and Z1', unless the search was over before this call.

    Z1 and Z1' are extrapolated by the time `move`. Return 1 if the search goes on, else 0.
    """
    going = a[MODE + i] <= ENDING
    a[T + i] = t
    a[MODE + i] = mode
    store_end(a, i, Z1, END_Z1, move, going)
    return 1 if mode <= ENDING else 0
