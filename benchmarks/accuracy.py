"""The loosest tolerance with which the error of a method stays within a limit.

A method is an integrator, and a scene a test case: a motion with starts (initial states) and exact
states at the end.
"""

import math
from typing import NamedTuple

from benchmarks.methods import TIMED, starts_of

LIMIT = 1e-9
# Tolerances are 10^(-k/STEPS) for k from LOOSEST (0.01) to TIGHTEST (3e-14, the tightest tolerance
# that SciPy accepts).
STEPS, LOOSEST, TIGHTEST = 4, 8, 54


class Found(NamedTuple):
    """A tolerance, the error with it, whether the error is within the limit, and the method.

    `run` is the method prepared for the scene: a function from starts to states at the end.
    """

    tolerance: float
    error: float
    met: bool
    run: object


def measured(scene, name, tolerance):
    """Return a method prepared for a scene, and its largest error, infinite if a run fails."""
    run = TIMED[name].prepare(scene, tolerance)
    error = scene.error(run(starts_of(scene, name)))
    return run, error if math.isfinite(error) else math.inf


def loosest(scene, name, limit=LIMIT):
    """Return the loosest tolerance with an error within the limit, by bisection, as `Found`.

    If no tolerance keeps the limit, return the tightest tolerance, with `met` False.
    """
    low, high = LOOSEST - 1, TIGHTEST
    best = Found(10 ** (-high / STEPS), math.nan, False, None)
    while high - low > 1:
        middle = (low + high) // 2
        tolerance = 10 ** (-middle / STEPS)
        run, error = measured(scene, name, tolerance)
        if error <= limit:
            high, best = middle, Found(tolerance, error, True, run)
        else:
            low = middle
    if best.run is None:
        run, error = measured(scene, name, best.tolerance)
        best = Found(best.tolerance, error, error <= limit, run)
    return best
