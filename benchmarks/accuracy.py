"""The loosest tolerance at which a method keeps the error of the state below a limit."""

import math
from typing import NamedTuple

from benchmarks.methods import TIMED, starts_of

LIMIT = 1e-9
# Tolerances are 10^(-k/STEPS), for k from LOOSEST to TIGHTEST, 3e-14, which SciPy
# still takes.
STEPS, LOOSEST, TIGHTEST = 4, 8, 54


class Found(NamedTuple):
    """A tolerance, the error it gives, and the method made ready with it; `met` is the limit."""

    tolerance: float
    error: float
    met: bool
    run: object


def measured(scene, name, tolerance):
    """A method with a tolerance, and its largest error over its starts."""
    run = TIMED[name].prepare(scene, tolerance)
    error = scene.error(run(starts_of(scene, name)))
    return run, error if math.isfinite(error) else math.inf


def loosest(scene, name, limit=LIMIT):
    """The loosest tolerance whose error is within the limit, by bisection.

    Where none is, the tightest tolerance is returned, and `met` is false.
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
