"""SciPy's integrators. SciPy's events locate contacts, or steps simply run across contacts."""

import math

import numpy as np
from scipy.integrate import solve_ivp

from chatterjee1995.methods.equations import RATE_OPERATIONS, ahead, rate, wall_at
from chatterjee1995.methods.integrator import Integrator
from impact_damper.kernel.compiling import kernel
from impact_damper.kernel.single import side_of
from impact_damper.model.packed import CLEARANCE, FREQUENCY

BY_POSITION = 2  # value of `side` for which the position Z2 determines the wall in contact
UNLIMITED = 2**62  # limit of evaluations of the rate, which no run reaches


@kernel
def derivative(t, y, p, side, left):
    """Return the derivative of the state y. Raise OverflowError after `left[0]` evaluations."""
    left[0] -= 1
    if left[0] < 0:
        raise OverflowError("too many evaluations")
    if side == BY_POSITION:
        side = wall_at(p, y[2])
    return np.array(rate(p, side, t, (y[0], y[1], y[2], y[3])))


def _event(_, y, p, side, left):
    return ahead(p, side, y[2])


_event.terminal, _event.direction = True, -1


def solved(method, p, y, span, side, tolerance, left, **options):
    """Run `solve_ivp` with rtol = atol = `tolerance` for at most `left[0]` evaluations of dy/dT."""
    given = {"args": (p, side, left), "rtol": tolerance, "atol": tolerance} | options
    with np.errstate(all="ignore"):
        return solve_ivp(derivative, span, y, method, **given)


def parts(method, p, start, t, end, tolerance, locate, left):
    """Yield the result of `solve_ivp` for the whole run.

    If `locate` is true, yield a result for each flight and each contact instead. Each evaluation of
    the rate reduces `left[0]`, the number of evaluations that are still allowed.
    """
    y, side = np.array(start), side_of(p, start) if locate else BY_POSITION
    status = 1
    while status == 1:
        events = _event if locate else None
        result = solved(method, p, y, (t, end), side, tolerance, left, events=events)
        status = result.status
        yield result
        if status == 1:
            t, y = result.t_events[0][0], result.y_events[0][0].copy()
            contact = 1 if y[2] > 0 else -1
            y[2] = contact * p[CLEARANCE]
            side = contact if side == 0 else 0


class SciPy(Integrator):
    """An integrator of SciPy. A comment at INTEGRATORS explains `operations`."""

    tolerances = "scipy"
    slow = True
    compared = ("accuracy", "missed_contacts")

    def __init__(self, name, place, operations, factorising=0):
        self.name = self.title = name
        self.place, self.operations, self.factorising = place, operations, factorising

    def steps(self, p, start, begin, periods, tolerance, locate, most_evaluations=UNLIMITED):
        locate = locate and p[CLEARANCE] < math.inf
        left, factorisations = np.array([most_evaluations]), 0
        times, ends, status = [np.array([begin])], [start[None]], "failed"
        end = begin + periods * 2 * math.pi / p[FREQUENCY]
        try:
            for part in parts(self.name, p, start, begin, end, tolerance, locate, left):
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
        work = evaluations * (RATE_OPERATIONS + self.operations) + factorisations * self.factorising
        return status, float(work), np.concatenate(times), np.concatenate(ends)

    def flight(self, p, state, end, resolution, time):
        given = state, (0.0, end), 0, resolution, np.array([UNLIMITED])
        result = solved(self.name, p, *given, dense_output=True)
        return (np.abs(result.y[2]), abs(result.sol(time)[2])) if result.success else None


# `operations` is the cost of the method itself for each evaluation of the rate. In a sum of states,
# a term costs 4 * 2 operations: a product and an addition for each of 4 components. DOP853 sums
# about 6 terms to get the state at which it evaluates the rate. To get the end and the error of a
# step it sums 4 terms for each evaluation in the step. LSODA sums 21 terms, and solves 4 linear
# equations with 2 * 4^2 operations. `factorising` is the cost of an LU factorisation: 2/3 * 4^3.
INTEGRATORS = (
    SciPy("DOP853", 4, operations=4 * 2 * (6 + 4)),
    SciPy("LSODA", 5, operations=4 * 2 * 21 + 2 * 4**2, factorising=2 * 4**3 // 3),
)
