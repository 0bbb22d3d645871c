"""Predicted rates at which the errors of harmonic balance decrease with the highest harmonic N.

With elastic contacts the force is continuous with kinks, and the Fourier coefficients k of Z1 and
Z2 decrease as k^-4. With a dashpot the force jumps at entry and exit, and they decrease as k^-3.
The following errors result (first power elastic, second power with dashpot):

- Root mean square of the omitted harmonics k > N: N^-3.5 or N^-2.5.
- Retained harmonics k <= N: their error is the effect of the omitted ones on the contact force.
  With the function M of time, which is 1 in contact and 0 elsewhere, it is the sum over |k| > N of
  the omitted coefficients times the coefficients of M, which decrease as 1/k. The sum is of order
  N^-4 or N^-3. For elastic contact the terms of k and -k cancel at this order, and N^-5 remains.
- max |Z1|, reached away from the ends of the contacts: the error of the retained harmonics plus
  the value of the omitted series at one instant, N^-4 or N^-3. For elastic contact the N^-5 term
  may be larger than the N^-4 term at small N.
- Floquet multipliers: N^-4 or N^-3. The coefficients of a disturbance decrease as k^-3 or k^-2. For
  elastic contact its omitted harmonics add N^-3 to the force at each end of a contact, but the
  error in the position of that end cancels this term: both are r1 (1 + 1/rm)/pi times the sum of
  k^-4 beyond N, with opposite signs. With a dashpot the terms of k and -k cancel.

These powers hold for N above `asymptotic_harmonic`. The errors oscillate about them, since entry
and exit of a contact contribute with a relative phase that changes with N.

Without contacts the motion is analytic in a strip of complex time around the real axis, up to its
nearest singularity at a distance s. The omitted harmonics decrease as exp(-s W N), the error of the
last retained ones as N^-2 exp(-s W N), and the error of the multipliers, which is quadratic in the
omitted harmonics, as exp(-2 s W N). With a linear spring there is no singularity, and N = 1 is
exact.
"""

import numpy as np
from scipy.integrate import solve_ivp

from impact_damper.kernel.equation import forcing_amplitude
from impact_damper.system.packed import CUBIC, DAMPING, FREQUENCY, STIFFNESS

# MEASURES: errors of max |Z1|, of the retained harmonics of Z1, of the omitted ones (both root mean
# square), and of a Floquet multiplier. ELASTIC and INELASTIC: their powers of 1/N, without and with
# a dashpot. ANALYTIC: their rates per harmonic without contacts, in units of s W.
MEASURES = ("maximum", "retained", "omitted", "multiplier")
ELASTIC = (4.0, 5.0, 3.5, 4.0)
INELASTIC = (3.0, 3.0, 2.5, 3.0)
ANALYTIC = (1.0, 1.0, 1.0, 2.0)
# Search for a singularity (`singularity_distance`). STARTS: number of start times in half a forcing
# period. LARGE: |Z1| at which an integration towards the singularity stops, in units of
# x = (f/|k3|)^(1/3). LAST_CHANGE of the estimated place on convergence, in units of 1/(x sqrt|k3|).
# CLOSE: share of the estimated distance that the next integration covers.
STARTS = 12
LARGE = 30.0
LAST_CHANGE = 1e-6
CLOSE = 0.95


def asymptotic_harmonic(damper, frequency) -> float:
    """Lowest harmonic number N from which on the predicted powers can hold; 1 without a damper.

    Harmonic N must resolve a contact: its period 2 pi/(N W) is the duration of a contact without
    other forces, pi/(w sqrt(1 - z^2)) with w^2 = r1 (1 + 1/rm) and z = zc sqrt(1 + rm) (appendix
    B). With a dashpot N is also at least r1/(c W), c = 2 zc sqrt(r1 rm): above this harmonic the
    jump c Z2' of the force has a larger Fourier coefficient than its kink r1 Z2'.

    Parameters
    ----------
    damper : Damper or None
    frequency : float
        W, dimensionless.
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
    """Predicted decrease of each error in `MEASURES` with the highest harmonic N.

    Parameters
    ----------
    damper : Damper or None
    p : array, shape (packed.COUNT,)
        Packed parameters.
    state : array, shape (4,)
        State of the exact orbit at W T = pi/2: Z1, Z1', Z2, Z2'.

    Returns
    -------
    kind : str
        "algebraic": the error decreases as N^-rate. "exponential": as exp(-rate N).
    rates : numpy.ndarray, shape (4,)
    """
    if damper is None:
        return "exponential", np.array(ANALYTIC) * p[FREQUENCY] * singularity_distance(p, state)
    return "algebraic", np.array(ELASTIC if damper.restitution == 1 else INELASTIC)


def singularity_distance(p, state) -> float:
    """Distance from the real time axis to the nearest singularity of a free motion.

    From STARTS points of the real axis, over half a forcing period, the motion is integrated in
    the direction of imaginary time. Near a singularity T* the motion is
    Z1 = sqrt(-2/k3)/(T - T*), so T* is estimated as T + Z1/Z1'. The next integration goes straight
    from the real part of this estimate towards it.

    Parameters
    ----------
    p, state
        As in `decay`.

    Returns
    -------
    float
        In units of T; infinite for a linear spring, NaN if no singularity is found.
    """
    frequency, cubic = p[FREQUENCY], p[CUBIC]
    if cubic == 0:
        return np.inf
    force = forcing_amplitude.py_func(p)
    length = (force / abs(cubic)) ** (1 / 3)
    duration = 1 / (np.sqrt(abs(cubic)) * length)

    def rates(time, y):
        x, v = y
        drive = force * np.cos(frequency * time)
        return np.array([v, drive - p[DAMPING] * v - p[STIFFNESS] * x - cubic * x**3])

    def integrate(y, begin, end):
        """Time and state at the end of a straight line in complex time, or where |Z1| is LARGE."""

        def large(share, y):
            return LARGE * length - abs(y[0])

        large.terminal = True
        run = solve_ivp(
            lambda share, y: (end - begin) * rates(begin + share * (end - begin), y),
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
