"""Motions by SciPy's integrators, with nothing but compiled functions where they are called often.

`impact_damper.rivals.scipy_methods.run_scipy` counts evaluations and samples every period, at the
cost of a quarter of its time; a rival is timed without.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of
from impact_damper.rivals.equations import rate, wall_at

BY_POSITION = 2
# Evaluations of the rate after which a run is given up.
MOST_EVALUATIONS = 200_000


@kernel
def derivative(t, y, p, side, left):
    """Rate of the state; BY_POSITION chooses the wall. `left` (1,) counts evaluations down."""
    left[0] -= 1
    if left[0] < 0:
        raise OverflowError("too many evaluations")
    if side == BY_POSITION:
        side = wall_at(p, y[2])
    return np.array(rate(p, side, t, (y[0], y[1], y[2], y[3])))


@kernel
def ahead(t, y, p, side, left):
    """How far the next event is: the gap in flight, the penetration in contact."""
    return p[3] - abs(y[2]) if side == 0 else side * y[2] - p[3]


def _gap(*arguments):
    return ahead(*arguments)


_gap.terminal, _gap.direction = True, -1


def run(method, p, start, begin, end, tolerance, locate):
    """State at the end, NaN where the run failed or was given up.

    Parameters
    ----------
    method : str
        "DOP853", "LSODA" or "Radau".
    p, start : array, shapes (7,) and (4,)
        Packed parameters and a state in flight.
    begin, end, tolerance : float
        Both relative and absolute tolerance.
    locate : bool
        Whether contacts are events, each of which ends a run and begins another.
    """
    t, y, left = begin, start.copy(), np.array([MOST_EVALUATIONS])
    locate = locate and p[3] < math.inf
    side = side_of(p, y) if locate else BY_POSITION
    while t < end:
        try:
            with np.errstate(all="ignore"):
                part = solve_ivp(
                    derivative,
                    (t, end),
                    y,
                    method,
                    events=_gap if locate else None,
                    args=(p, side, left),
                    rtol=tolerance,
                    atol=tolerance,
                )
        except OverflowError:
            return np.full(4, np.nan)
        if part.status < 0:
            return np.full(4, np.nan)
        t, y = part.t[-1], part.y[:, -1]
        if part.status == 1:
            t, y = part.t_events[0][0], part.y_events[0][0].copy()
            contact = 1 if y[2] > 0 else -1
            y[2] = contact * p[3]
            side = contact if side == 0 else 0
    return y
