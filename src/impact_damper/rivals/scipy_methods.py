"""SciPy's integrators, through the kink or with contacts as events; the rate is compiled."""

import math

import numpy as np
from scipy.integrate import solve_ivp

from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of
from impact_damper.rivals.equations import rate, wall_at
from impact_damper.system.packed import CLEARANCE, FREQUENCY

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


class TooManyEvaluations(Exception):
    """A run has used up the evaluations it may make."""


class Counted:
    """The rate, which counts how often it is asked for.

    Attributes
    ----------
    evaluations, jacobians, factorisations : int
        Of the rate so far; the others of implicit methods, as SciPy reports them.
    """

    def __init__(self, most):
        self.most = most
        self.evaluations, self.jacobians, self.factorisations = 0, 0, 0

    def __call__(self, t, y, p, side):
        self.evaluations += 1
        if self.evaluations > self.most:
            raise TooManyEvaluations
        return derivative(t, y, p, side)


def pieces(method, p, start, t, end, tolerance, locate, counted, times=None):
    """Runs of SciPy's `solve_ivp`, from contact to contact if these are located.

    The gap is then an event that ends a run, from which the next one starts with the wall that
    acts fixed; otherwise the wall is chosen by the position, and there is one run.

    Parameters
    ----------
    method : str
        One of `METHODS`.
    p, start : array
        Packed parameters and a state.
    t, end, tolerance : float
        Time of the start and of the end; both relative and absolute tolerance.
    locate : bool
    counted : Counted
    times : array or None
        Where states are asked for, instead of at the ends of steps.

    Raises
    ------
    TooManyEvaluations
        Started at a wall and with a loose tolerance, a method can step over the end of a contact.
    """
    y, side = np.array(start), side_of(p, start) if locate else BY_POSITION

    def gap(_, y, p, side):
        return p[CLEARANCE] - abs(y[2]) if side == 0 else side * y[2] - p[CLEARANCE]

    gap.terminal, gap.direction = True, -1
    status = 1
    while status == 1:
        with np.errstate(all="ignore"):
            run = solve_ivp(
                counted,
                (t, end),
                y,
                method,
                t_eval=None if times is None else times[times > t],
                events=gap if locate else None,
                args=(p, side),
                rtol=tolerance,
                atol=tolerance,
            )
        counted.jacobians += run.njev
        counted.factorisations += run.nlu
        status = run.status
        yield run
        if status == 1:
            t, y = run.t_events[0][0], run.y_events[0][0].copy()
            contact = 1 if y[2] > 0 else -1
            y[2] = contact * p[CLEARANCE]
            side = contact if side == 0 else 0


def run_scipy(method, p, start, t, tolerance, locate, periods, most_evaluations=10**6):
    """States (periods, 4) after each forcing period, NaN from a failure on.

    Parameters
    ----------
    method, p, start, t, tolerance, locate
        As of `pieces`.
    periods : int
    most_evaluations : int
        Of the rate, in all; a run that needs more is given up as a failure.
    """
    times = t + 2 * math.pi / p[FREQUENCY] * np.arange(1, periods + 1)
    strobes = np.full((periods, 4), np.nan)
    done = 0
    counted = Counted(most_evaluations)
    try:
        for run in pieces(method, p, start, t, times[-1], tolerance, locate, counted, times):
            if len(run.t) > 0:
                strobes[done : done + len(run.t)] = run.y.T
                done += len(run.t)
    except TooManyEvaluations:
        pass
    return strobes
