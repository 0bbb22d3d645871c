"""CVODE of SUNDIALS with root finding, through scikit-sundae, with compiled equations.

The method is Adams', which the documentation recommends for problems that are not stiff. The one
root function is |Z2| - d0. At a root CVODE returns and starts again, in contact or in flight.
"""

import math
from importlib.metadata import version as version_of

import numba
import numpy as np

from benchmarks.rivals import coefficients, lacks

STEPS = 10**7  # largest number of steps between two contacts


def obstacle():
    return lacks("sksundae", "scikit-sundae")


def version():
    return f"scikit-sundae {version_of('scikit-sundae')}"


def equations(p):
    """Return compiled rates and root function. `side` is 0 in flight, -1 or 1 at a wall."""
    h, linear, cubic, amplitude, w, d0, wall, dashpot, heavy = coefficients(p)

    @numba.njit
    def rates(t, y, out, side):
        free = amplitude * math.cos(w * t) - h * y[1] - (linear + cubic * y[0] * y[0]) * y[0]
        force = wall * (y[2] - side[0] * d0) + dashpot * y[3] if side[0] else 0.0
        out[0], out[1] = y[1], free - force
        out[2], out[3] = y[3], free - heavy * force

    @numba.njit
    def beyond(t, y, out, side):
        out[0] = abs(y[2]) - d0

    return rates, beyond


def prepare(scene, tolerance):
    from sksundae.cvode import CVODE

    rates, beyond = equations(scene.parameters)
    side = np.zeros(1, np.int64)
    roots = {}
    if scene.components == 4:

        def reached(t, y, out, phase):
            beyond(t, y, out, phase)

        reached.terminal, reached.direction = [True], [0]
        roots = {"eventsfn": reached, "num_events": 1}
    accuracy = {"rtol": tolerance, "atol": tolerance, "max_num_steps": STEPS}
    solver = CVODE(rates, userdata=side, method="Adams", **accuracy, **roots)

    def run(starts):
        states, contacts = np.empty((len(starts), 4)), np.zeros(len(starts), int)
        for i, start in enumerate(starts):
            side[0] = 0
            t, y = scene.begin, start
            while t < scene.end:
                solver.init_step(t, y)
                found = solver.step(scene.end, tstop=scene.end)
                if not found.success:
                    y = np.full(4, np.nan)
                    break
                t, y = found.t, found.y
                if t < scene.end:
                    side[0] = 0 if side[0] else math.copysign(1, y[2])
                    contacts[i] += side[0] != 0
            states[i] = y
        return states, contacts

    return run
