"""Predicted rates at which the errors of harmonic balance decrease with the highest harmonic N.

With elastic contacts the contact force is continuous with kinks, and coefficient k of the Fourier
series of Z1 and Z2 decreases as k^-4. With a dashpot the force jumps at the beginning and end of a
contact, and the coefficients decrease as k^-3. The errors below follow from these powers. Where
two powers are given, the first is for elastic contacts and the second for contacts with a dashpot.

- Root mean square of the omitted harmonics k > N: N^-3.5 or N^-2.5.
- Error of the retained harmonics k <= N: N^-5 or N^-3. The omitted harmonics cause this error
  through the contact force. Let M be the function of time that is 1 in contact and 0 elsewhere; its
  coefficients decrease as 1/k. The force on a retained harmonic k changes by the sum, over the
  omitted harmonics |n| > N, of coefficient n of the motion times coefficient k - n of M. This sum
  is of order N^-4 or N^-3. For elastic contact the terms of n and -n cancel at the order N^-4.
- Error of max |Z1|: N^-4 or N^-3. It is the error of the retained harmonics plus the value of the
  omitted series at one instant, provided that max |Z1| is reached away from the ends of the
  contacts. For elastic contact the N^-5 term may be larger than the N^-4 term at small N.
- Error of the Floquet multipliers: N^-4 or N^-3. The coefficients of a disturbance decrease as k^-3
  or k^-2. For elastic contact the omitted harmonics of the disturbance change the force at each end
  of a contact by r1 (1 + 1/rm)/pi times the sum of k^-4 over k > N, which is of order N^-3. The
  error in the time of this end cancels this order, and N^-4 remains. With a dashpot the terms of
  k and -k cancel.

These powers hold for N above `asymptotic_harmonic`. The errors oscillate about the powers, because
the beginning and end of a contact contribute with a relative phase that changes with N.

Without contacts the motion can be continued to complex time T, up to the nearest point at which Z1
becomes infinite (singularity). Let s be the distance of this point from the real axis. The omitted
harmonics decrease as exp(-s W N) and the error of the last retained harmonics as N^-2 exp(-s W N).
The error of the multipliers is quadratic in the omitted harmonics and decreases as exp(-2 s W N).
With a linear spring there is no singularity, and N = 1 is exact.

Symbols are as in `system.parameters`.
"""

import numpy as np
from scipy.integrate import solve_ivp

from impact_damper.kernel.equation import forcing_amplitude
from impact_damper.model.packed import DAMPING, FREQUENCY, cubic_spring

# MEASURES   error of max |Z1|; root mean squares of the errors of the retained harmonics of Z1 and
#            of the omitted harmonics of Z1; error of a Floquet multiplier
# ELASTIC    powers of 1/N of these errors for elastic contacts
# INELASTIC  powers of 1/N of these errors for contacts with a dashpot
# ANALYTIC   rates of exponential decrease of these errors without contacts, in units of s W
MEASURES = ("maximum", "retained", "omitted", "multiplier")
ELASTIC = (4.0, 5.0, 3.5, 4.0)
INELASTIC = (3.0, 3.0, 2.5, 3.0)
ANALYTIC = (1.0, 1.0, 1.0, 2.0)
# Search for a singularity (`singularity_distance`), with the forcing amplitude f and
# x = (f/|k3|)^(1/3):
# STARTS       number of start times in half a forcing cycle
# LARGE        |Z1| at which an integration towards the singularity stops, in units of x
# LAST_CHANGE  largest change of the estimated position in the last iteration, in units of
#              1/(x sqrt|k3|)
# CLOSE        fraction of the estimated distance that the next integration covers
STARTS = 12
LARGE = 30.0
LAST_CHANGE = 1e-6
CLOSE = 0.95


def asymptotic_harmonic(damper, frequency) -> float:
    """Return the harmonic number N above which the predicted powers can hold; 1 without a damper.

    Harmonic N must resolve a contact. Its period 2 pi/(N W) equals the duration of a contact
    without other forces, pi/(w sqrt(1 - z^2)) with w^2 = r1 (1 + 1/rm) and z = zc sqrt(1 + rm)
    (appendix B). With a dashpot N is also at least r1/(c W), with c = 2 zc sqrt(r1 rm). Above this
    harmonic the jump of the contact force, c Z2', contributes more to a coefficient than the jump
    of its slope, r1 Z2'.
    """
    if damper is None:
        return 1.0
    natural = damper.contact_stiffness * (1 + 1 / damper.mass_ratio)
    ratio = damper.contact_damping**2 * (1 + damper.mass_ratio)
    resolving = 2 * np.sqrt(natural * (1 - ratio)) / frequency
    if damper.restitution == 1:
        return float(resolving)
    return float(max(resolving, damper.contact_stiffness / (damper.dashpot * frequency)))


def decay(damper, p, state) -> tuple:
    """Return the predicted decrease of each error in `MEASURES` with the highest harmonic N."""
    if damper is None:
        return "exponential", np.array(ANALYTIC) * p[FREQUENCY] * singularity_distance(p, state)
    return "algebraic", np.array(ELASTIC if damper.restitution == 1 else INELASTIC)


def singularity_distance(p, state) -> float:
    """Return the distance from the real time axis to the nearest singularity of a free motion.

    The motion is integrated in the direction of imaginary time, from STARTS points of the real axis
    in half a forcing cycle. Near a singularity T* the motion is Z1 = sqrt(-2/k3)/(T - T*), so T* is
    estimated as T + Z1/Z1'. The next integration leads along a straight line from the real part of
    the estimate towards the estimate.
    """
    frequency, (stiffness, cubic) = p[FREQUENCY], cubic_spring(p)
    if cubic == 0:
        return np.inf
    force = forcing_amplitude.py_func(p)
    length = (force / abs(cubic)) ** (1 / 3)
    duration = 1 / (np.sqrt(abs(cubic)) * length)

    def rates(time, y):
        x, v = y
        drive = force * np.cos(frequency * time)
        return np.array([v, drive - p[DAMPING] * v - stiffness * x - cubic * x**3])

    def integrate(y, begin, end):
        """Return time and state at the end of a line in complex time, or where |Z1| is LARGE."""

        def large(fraction, y):
            return LARGE * length - abs(y[0])

        large.terminal = True
        run = solve_ivp(
            lambda fraction, y: (end - begin) * rates(begin + fraction * (end - begin), y),
            (0, 1),
            y.astype(complex),
            method="DOP853",
            events=large,
            rtol=1e-10,
            atol=1e-12 * length,
        )
        return begin + run.t[-1] * (end - begin), run.y[:, -1]

    begin = 0.5 * np.pi / frequency
    heights = []
    for lag in np.pi / frequency * np.arange(STARTS) / STARTS:
        _, real = integrate(state[:2], begin, begin + lag)
        time, y = integrate(real, begin + lag, begin + lag + 1j * np.pi / frequency)
        for _ in range(8):
            before, singularity = time, time + y[0] / y[1]
            if not 0 < singularity.imag < 2 * np.pi / frequency:
                break
            _, real = integrate(state[:2], begin, singularity.real)
            close = complex(singularity.real, CLOSE * singularity.imag)
            time, y = integrate(real, complex(singularity.real), close)
            if abs(time - before) < LAST_CHANGE * duration:
                heights.append(singularity.imag)
                break
    return float(min(heights, default=np.nan))
