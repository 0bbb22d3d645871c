"""SciPy's integrators, through the kink or with contacts as events; the rate is compiled."""

import math

import numpy as np
from scipy.integrate import solve_ivp

from impact_damper.accelerate import kernel
from impact_damper.kernel import side_of
from impact_damper.rivals.equations import rate, wall_at

METHODS = ("RK45", "DOP853", "LSODA", "Radau")
BY_POSITION = 2


@kernel
def derivative(t, y, p, side):
    """Rate of the state while a wall acts; BY_POSITION chooses the wall by the position."""
    if side == BY_POSITION:
        side = wall_at(p, y[2])
    return np.array(rate(p, side, t, (y[0], y[1], y[2], y[3])))


def flight_steps(method, p, y, t, end, tolerance):
    """States (n, 4) at the ends of the steps in flight, SciPy's interpolant, and its success."""
    with np.errstate(all="ignore"):
        run = solve_ivp(
            derivative,
            (t, end),
            y,
            method,
            args=(p, 0),
            rtol=tolerance,
            atol=tolerance,
            dense_output=True,
        )
    return run.y.T, run.sol, run.success


class _TooManyEvaluations(Exception):
    pass


def run_scipy(method, p, start, t, tolerance, locate, periods, most_evaluations=10**6):
    """States (periods, 4) after each forcing period, NaN from a failure on.

    Parameters
    ----------
    method : str
        One of `METHODS`.
    p, start : array
        Packed parameters and a state.
    t, tolerance : float
        Time of the start; both relative and absolute tolerance.
    locate : bool
        Whether the gap is an event that ends a run, from which the next one starts with the wall
        that acts fixed; otherwise the wall is chosen by the position.
    periods : int
    most_evaluations : int
        Of the rate, in all; a run that needs more is given up as a failure. Started at a wall
        and with a loose tolerance, a method can step over the end of a contact.
    """
    times = t + 2 * math.pi / p[0] * np.arange(1, periods + 1)
    strobes = np.full((periods, 4), np.nan)
    y, side = np.array(start), side_of(p, start) if locate else BY_POSITION
    done, evaluations = 0, 0

    def counted(t, y, p, side):
        nonlocal evaluations
        evaluations += 1
        if evaluations > most_evaluations:
            raise _TooManyEvaluations
        return derivative(t, y, p, side)

    def gap(_, y, p, side):
        return p[3] - abs(y[2]) if side == 0 else side * y[2] - p[3]

    gap.terminal, gap.direction = True, -1
    while done < periods:
        try:
            with np.errstate(all="ignore"):
                run = solve_ivp(
                    counted,
                    (t, times[-1]),
                    y,
                    method,
                    t_eval=times[done:],
                    events=gap if locate else None,
                    args=(p, side),
                    rtol=tolerance,
                    atol=tolerance,
                )
        except _TooManyEvaluations:
            break
        if len(run.t) > 0:
            strobes[done : done + len(run.t)] = run.y.T
            done += len(run.t)
        if run.status != 1:
            break
        t, y = run.t_events[0][0], run.y_events[0][0].copy()
        contact = 1 if y[2] > 0 else -1
        y[2] = contact * p[3]
        side = contact if side == 0 else 0
    return strobes
