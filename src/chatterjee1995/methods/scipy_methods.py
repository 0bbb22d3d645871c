"""SciPy's integrators with a compiled rate (time derivative) of the state.

The force has a kink where a contact begins or ends. The integrators step across these kinks, or
locate contacts as events of `solve_ivp`.

Z2 is the displacement of the primary mass relative to the loose mass. A strobe is the time in each
cycle at which the forcing has the phase W T = pi/2.
"""

import math

import numpy as np
from scipy.integrate import solve_ivp

from chatterjee1995.methods.equations import rate, wall_at
from chatterjee1995.methods.operations import operations
from chatterjee1995.methods.runs import Integrator, read_off, stopped
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of
from impact_damper.model.packed import CLEARANCE, FREQUENCY

# Components of the state.
SIZE = 4
# Floating-point operations of a method for each evaluation of the rate, in addition to those of the
# rate itself. n is SIZE, and a product with its addition counts as two operations.
# DOP853: for each evaluation and component on average 6 products for the next state, and 4 for the
#     final values and the two error estimates.
# LSODA: an array of about 6 derivatives is predicted and corrected, with 21 additions per component
#     each. A system is solved with LU factors, 2 n^2.
# Radau: an iteration has 3 evaluations. Per component they take 9 products to transform and 9 to
#     transform back. A real and a complex system are solved, 2 n^2 and 8 n^2.
COMBINING = {
    "DOP853": SIZE * 2 * (6 + 4),
    "LSODA": SIZE * 2 * 21 + 2 * SIZE**2,
    "Radau": SIZE * 2 * 6 + (2 + 8) * SIZE**2 // 3,
}
# Operations of a factorisation, 2/3 n^3 if real and 8/3 n^3 if complex; for Radau the mean of both.
FACTORISING = {"DOP853": 0, "LSODA": 2 * SIZE**3 // 3, "Radau": (2 + 8) * SIZE**3 // 3 // 2}
# Value of the argument `side` with which the position Z2 determines the wall in contact.
BY_POSITION = 2
# Largest number of evaluations of the rate: EVALUATIONS in each forcing cycle of a run, MOST_TIMED
# in a whole run of the benchmarks, and a number that is never reached.
EVALUATIONS, MOST_TIMED = 2000, 200_000
UNLIMITED = 2**62


@kernel
def derivative(t, y, p, side, left):
    """Return the rate of the state, and reduce `left[0]` by one.

    `side` is the wall in contact (-1, 1, or 0 for none), or BY_POSITION. `left`, shape (1,), holds
    the number of evaluations that are still allowed. If it is 0, OverflowError is raised.
    """
    left[0] -= 1
    if left[0] < 0:
        raise OverflowError("too many evaluations")
    if side == BY_POSITION:
        side = wall_at(p, y[2])
    return np.array(rate(p, side, t, (y[0], y[1], y[2], y[3])))


@kernel
def ahead(t, y, p, side, left):
    """Return the distance to the nearest wall in flight, or the penetration in contact.

    Both decrease through zero, the distance when a contact begins, the penetration when it ends.
    """
    return p[CLEARANCE] - abs(y[2]) if side == 0 else side * y[2] - p[CLEARANCE]


def _event(*arguments):
    return ahead(*arguments)


_event.terminal, _event.direction = True, -1


def pieces(method, p, start, t, end, tolerance, locate, left, times=None):
    """Yield the results of `solve_ivp` for successive parts of a run.

    With `locate` the beginning or end of a contact is an event, which ends a part. The next part
    begins at the event. Within a part the wall in contact, or the absence of contact, is fixed.
    Without `locate` the run is one part, and each evaluation of the rate determines the wall in
    contact from the position Z2.

    Parameters
    ----------
    method : str
        Name of the method in SciPy.
    p, start : array
        Packed parameters and a state.
    t, end, tolerance : float
        Time of the first state, time of the end, and tolerance, both relative and absolute.
    locate : bool
    left : array of int, shape (1,)
        Number of evaluations of the rate that are still allowed; it is reduced by each evaluation.
    times : array or None
        Times at which states are returned; None for the ends of steps.

    Raises
    ------
    OverflowError
        If more than `left` evaluations are needed. This can happen when a method with a large
        tolerance begins at a wall and steps over the end of the contact.
    """
    y, side = np.array(start), side_of(p, start) if locate else BY_POSITION
    status = 1
    while status == 1:
        with np.errstate(all="ignore"):
            result = solve_ivp(
                derivative,
                (t, end),
                y,
                method,
                t_eval=None if times is None else times[times > t],
                events=_event if locate else None,
                args=(p, side, left),
                rtol=tolerance,
                atol=tolerance,
            )
        status = result.status
        yield result
        if status == 1:
            t, y = result.t_events[0][0], result.y_events[0][0].copy()
            contact = 1 if y[2] > 0 else -1
            y[2] = contact * p[CLEARANCE]
            side = contact if side == 0 else 0


class SciPy(Integrator):
    """One of SciPy's methods.

    Parameters
    ----------
    method : str
        "RK45", "DOP853", "LSODA" or "Radau".
    """

    def __init__(self, method):
        self.method = method

    def run(self, p, start, begin, periods, tolerance, locate, most_evaluations):
        """Return the run.

        Its counted work, the number of floating-point operations, includes all evaluations of the
        rate, also for Jacobians by differences, and the operations in COMBINING and FACTORISING.
        """
        left, factorisations = np.array([most_evaluations]), 0
        times, ends, status = [np.array([begin])], [start[None]], "failed"
        end = begin + periods * 2 * math.pi / p[FREQUENCY]
        try:
            for part in pieces(self.method, p, start, begin, end, tolerance, locate, left):
                factorisations += part.nlu
                status = "failed" if part.status < 0 else "ended"
                later, states = part.t[1:].copy(), part.y.T[1:].copy()
                if part.status == 1:
                    states[-1, 2] = math.copysign(p[CLEARANCE], states[-1, 2])
                times.append(later)
                ends.append(states)
        except OverflowError:
            status = "capped"
        evaluations = most_evaluations - int(left[0])
        each = operations(rate) + COMBINING[self.method]
        work = float(evaluations * each + factorisations * FACTORISING[self.method])
        if status != "ended":
            return stopped(status, work)
        return read_off(p, work, np.concatenate(times), np.concatenate(ends))

    def strobes(self, p, start, begin, periods, resolution, locate, most_evaluations=None):
        """Return the states after each forcing cycle (see `Integrator.strobes`).

        By default `most_evaluations` is EVALUATIONS times `periods`.
        """
        times = begin + 2 * math.pi / p[FREQUENCY] * np.arange(1, periods + 1)
        strobes, done = np.full((periods, 4), np.nan), 0
        left = np.array([most_evaluations or EVALUATIONS * periods])
        arguments = self.method, p, start, begin, times[-1], resolution, locate, left, times
        try:
            for part in pieces(*arguments):
                if len(part.t) > 0:
                    strobes[done : done + len(part.t)] = part.y.T
                    done += len(part.t)
        except OverflowError:
            pass
        return strobes

    def flight(self, p, state, end, resolution, time):
        """Return |Z2| of a flight (see `Integrator.flight`), at `time` by SciPy's interpolant."""
        with np.errstate(all="ignore"):
            result = solve_ivp(
                derivative,
                (0.0, end),
                state,
                self.method,
                args=(p, 0, np.array([UNLIMITED])),
                rtol=resolution,
                atol=resolution,
                dense_output=True,
            )
        return (np.abs(result.y[2]), abs(result.sol(time)[2])) if result.success else None

    def end(self, p, start, begin, periods, tolerance, locate):
        """Return the state at the end. To save time, states after each cycle are not computed."""
        left, end = np.array([MOST_TIMED]), begin + periods * 2 * math.pi / p[FREQUENCY]
        locate = locate and p[CLEARANCE] < math.inf
        try:
            *_, last = pieces(self.method, p, start, begin, end, tolerance, locate, left)
        except OverflowError:
            return np.full(4, np.nan)
        return last.y[:, -1] if last.status == 0 else np.full(4, np.nan)
