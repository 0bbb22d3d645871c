"""Bifurcations and grazings of symmetric orbits of period 1, located in 80-bit arithmetic.

The unknowns are the state and the parameter. The equations are the map over half a cycle followed
by a change of sign, and a test function that is zero at the event. Newton's method solves them with
difference quotients in 80 bits. Only the linear systems are solved in double precision.
"""

import math

import numpy as np

from impact_damper.model.packed import FREQUENCY
from references import extended

# Step of the difference quotients. Near a grazing the distances to the wall are only 1e-10.
STEP = 1e-13
ITERATIONS = 8


def _half(p, state, phase):
    """Return the 80-bit motion over half a cycle from a phase W T."""
    frequency = extended.Real(p[FREQUENCY])
    begin = extended.Real(phase) / frequency
    return extended.run(p, state, begin, [begin + np.arccos(extended.Real(-1)) / frequency])


def _test(kind, run, wall_phase, p):
    """Return the test function of an event; `wall_phase` is the phase at which a contact grazes.

    Matrices are rounded to double precision. A complex pair of multipliers has the modulus 1 where
    a product of two eigenvalues of `root` is 1.
    """
    root = -run.flow.astype(float)
    if kind == "fold":
        return np.linalg.det(root - np.eye(4))
    if kind == "symmetry_breaking":
        return np.linalg.det(root + np.eye(4))
    if kind == "neimark_sacker":
        values, pairs = np.linalg.eigvals(root), np.triu_indices(4, 1)
        return np.prod(np.prod(values[np.array(pairs)], axis=0) - 1).real
    times = run.turnings[:, 0] * p[FREQUENCY]
    near = np.argmin(np.abs((times - wall_phase + math.pi / 2) % math.pi - math.pi / 2))
    return run.turnings[near, 2]


def located(kind, family, value, state, phase):
    """Return the parameter of an event, and the residual of the orbit at this parameter.

    `kind` is "fold", "symmetry_breaking", "neimark_sacker", "grazing", or "merging" of two contacts
    with a wall. `family` maps the parameter to packed parameters. `value`, `state` and `phase`
    describe an orbit close to the event.
    """
    first = _half(family(value), state, phase)
    wall_phase = None
    if kind in ("grazing", "merging"):
        k = int(np.argmin(np.abs(first.turnings[:-1, 2])))
        wall_phase = float(first.turnings[k, 0] * family(value)[FREQUENCY])

    def equations(x):
        p = family(float(x[4]))
        run = _half(p, x[:4], phase)
        return np.append(-run.states[-1] - x[:4], _test(kind, run, wall_phase, p))

    x = np.append(np.array(state, extended.Real), extended.Real(value))
    for _ in range(ITERATIONS):
        here = equations(x)
        slopes = np.empty((5, 5))
        for k in range(5):
            nudged = x.copy()
            # The parameter is rounded to a double, so its step is computed after rounding.
            nudged[k] = float(x[k]) + STEP * (1 + abs(float(x[k]))) if k == 4 else x[k] + STEP
            slopes[:, k] = ((equations(nudged) - here) / (nudged[k] - x[k])).astype(float)
        change = np.linalg.solve(slopes, -here.astype(float))
        x = x + change
        x[4] = extended.Real(float(x[4]))
        if np.max(np.abs(change)) < 1e-13:
            break
    return float(x[4]), float(np.max(np.abs(equations(x)[:4])))
