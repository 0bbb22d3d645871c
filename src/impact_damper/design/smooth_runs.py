"""Integration of a machine with a tuned absorber, or without absorber: smooth motions, no contacts.

    x'' = f cos T - h x' - (k + k3 x^2) x - n
    u'' = x'' - n/m,    n = (kappa + kappa3 u^2) u + eta u'

x is the displacement of the machine, and u the displacement of the machine relative to the
absorber. f is the amplitude of the force; h, k and k3 are damping, stiffness and cubic stiffness of
the machine; m is the mass of the absorber; kappa, eta and kappa3 are stiffness, damping and cubic
stiffness of its spring and dashpot. All are divided by the mass of the machine. The time T is the
phase of the forcing in radian. The state is (x, x', u, u'). Without an absorber n and 1/m are 0,
and u has no meaning.

The method has the coefficients of SciPy's DOP853, order 8, and fixed steps. The caller chooses
steps that are short compared with the fastest vibration, so no step has to be rejected.
"""

import math

import numpy as np
from scipy.integrate import DOP853

from impact_damper.kernel.compiling import kernel, kernel_only

# Indices in the parameters of a run.
FORCE, DAMPING, STIFFNESS, CUBIC, INVERSE_MASS, LINK_STIFFNESS, LINK_DAMPING, LINK_CUBIC = range(8)
COUNT, SIZE = 8, 4
STAGES = DOP853.n_stages
FRACTIONS = DOP853.C[:STAGES].copy()
# Coefficients of the stages; the last row holds the weights of the final sum.
TABLEAU = np.zeros((STAGES + 1, STAGES))
TABLEAU[:STAGES] = DOP853.A[:STAGES, :STAGES]
TABLEAU[STAGES] = DOP853.B
# Number of Newton corrections of the time of an extremum within a step.
CORRECTIONS = 4


@kernel
def run(p, states, numbers, periods, slopes, largest):
    """Integrate states over forcing cycles, in place, from T = 0 on.

    Parameters
    ----------
    p : numpy.ndarray, shape (n, COUNT)
        Parameters of each run.
    states : numpy.ndarray, shape (n, SIZE)
    numbers : numpy.ndarray of int, shape (n,)
        Steps in a forcing cycle.
    periods : int
        Number of forcing cycles.
    slopes : numpy.ndarray, shape (n, SIZE, SIZE) or (n, 0, SIZE)
        Receives derivatives of the last state. Row j is the derivative with respect to component j
        of the first state. With the shape (n, 0, SIZE) no derivatives are computed.
    largest : numpy.ndarray, shape (n, SIZE)
        Receives the largest modulus of each component. For displacements it is the maximum over
        time, for velocities the maximum over the ends of steps.
    """
    rows = 1 + slopes.shape[1]
    y, here = np.zeros((rows, SIZE)), np.zeros((rows, SIZE))
    rates, ends = np.zeros((STAGES, rows, SIZE)), np.zeros((4, SIZE))
    most = 0
    for number in numbers:
        most = max(most, number)
    cosines, force, counted = np.zeros((most, STAGES)), np.zeros(STAGES), 0
    for i in range(len(states)):
        for k in range(SIZE):
            y[0, k] = states[i, k]
            largest[i, k] = abs(y[0, k])
            for row in range(1, rows):
                y[row, k] = 1.0 if k == row - 1 else 0.0
        h = 2.0 * math.pi / numbers[i]
        if numbers[i] != counted:
            counted = numbers[i]
            for place in range(counted):
                for stage in range(STAGES):
                    cosines[place, stage] = math.cos((place + FRACTIONS[stage]) * h)
        for place in range(periods * counted):
            phase = place % counted
            for stage in range(STAGES):
                force[stage] = p[i, FORCE] * cosines[phase, stage]
            for k in range(SIZE):
                ends[0, k] = y[0, k]
            step(p, i, y, force, h, rates, here)
            note_largest(p, i, y, force, h, rates, ends, largest)
        for k in range(SIZE):
            states[i, k] = y[0, k]
            for row in range(1, rows):
                slopes[i, row - 1, k] = y[row, k]


@kernel_only
def step(p, i, y, force, h, rates, here):
    """Replace a state (row 0 of y) and its tangents (other rows) by their values after a step.

    A tangent is a solution of the variational equations. `rates` and `here` are working memory.
    """
    for stage in range(STAGES + 1):
        for row in range(len(y)):
            s0 = s1 = s2 = s3 = 0.0
            for j in range(stage):
                weight = TABLEAU[stage, j]
                s0 += weight * rates[j, row, 0]
                s1 += weight * rates[j, row, 1]
                s2 += weight * rates[j, row, 2]
                s3 += weight * rates[j, row, 3]
            here[row, 0] = y[row, 0] + h * s0
            here[row, 1] = y[row, 1] + h * s1
            here[row, 2] = y[row, 2] + h * s2
            here[row, 3] = y[row, 3] + h * s3
        if stage < STAGES:
            write_rate(p, i, here, force[stage], rates[stage])
    for row in range(len(y)):
        for k in range(SIZE):
            y[row, k] = here[row, k]


@kernel_only
def write_rate(p, i, y, force, rate):
    """Write to `rate` the time derivatives of a state (row 0) and of its tangents (other rows)."""
    x, u, factor = y[0, 0], y[0, 2], 1.0
    for row in range(len(y)):
        spring = p[i, STIFFNESS] + factor * p[i, CUBIC] * x * x
        link = p[i, LINK_STIFFNESS] + factor * p[i, LINK_CUBIC] * u * u
        held = link * y[row, 2] + p[i, LINK_DAMPING] * y[row, 3]
        acceleration = force - p[i, DAMPING] * y[row, 1] - spring * y[row, 0] - held
        rate[row, 0] = y[row, 1]
        rate[row, 1] = acceleration
        rate[row, 2] = y[row, 3]
        rate[row, 3] = acceleration - held * p[i, INVERSE_MASS]
        force, factor = 0.0, 3.0


@kernel_only
def note_largest(p, i, y, force, h, rates, ends, largest):
    """Update the largest moduli by the moduli at the end of a step and at extrema within the step.

    Within the step a displacement is represented by the polynomial of degree 5 that agrees with
    displacement, velocity and acceleration at both ends of the step.
    """
    for k in range(SIZE):
        largest[i, k] = max(largest[i, k], abs(y[0, k]))
    for k in range(0, SIZE, 2):
        x, v, v1 = ends[0, k], h * ends[0, k + 1], h * y[0, k + 1]
        if v * v1 >= 0.0:
            continue
        write_rate(p, i, y, force[STAGES - 1], rates[STAGES - 1])
        a, a1 = h * h * rates[0, 0, k + 1], h * h * rates[STAGES - 1, 0, k + 1]
        rise, speed, bend = y[0, k] - x - v - 0.5 * a, v1 - v - a, a1 - a
        c3 = 10.0 * rise - 4.0 * speed + 0.5 * bend
        c4 = -15.0 * rise + 7.0 * speed - bend
        c5 = 6.0 * rise - 3.0 * speed + 0.5 * bend
        t = v / (v - v1)
        for _ in range(CORRECTIONS):
            slope = v + t * (a + t * (3.0 * c3 + t * (4.0 * c4 + t * 5.0 * c5)))
            curve = a + t * (6.0 * c3 + t * (12.0 * c4 + t * 20.0 * c5))
            if curve != 0.0:
                t = min(max(t - slope / curve, 0.0), 1.0)
        extremum = x + t * (v + t * (0.5 * a + t * (c3 + t * (c4 + t * c5))))
        largest[i, k] = max(largest[i, k], abs(extremum))
