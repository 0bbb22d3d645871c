"""How fast harmonic balance must converge, from the smoothness of the motion.

With contacts the force is continuous with kinks (elastic), or jumps at entry and exit (the
dashpot's), so that the coefficient k of Z1 and of Z2 falls as k^-4 or as k^-3. From that:

- the omitted harmonics, k > N, have a root mean square of N^-3.5 or N^-2.5;
- the retained ones err by what the omitted tail adds to the force over a contact, the sum over
  |k| > N of the tail's coefficients times those of M, which fall as 1/k: N^-4 or N^-3. For
  elastic contact the terms of k and -k cancel at this order, and N^-5 is left;
- max |Z1|, taken away from the ends of contacts, errs by that and by the omitted harmonics at one
  place, N^-4 or N^-3. For elastic contact N^-5 may outweigh N^-4 at first;
- a disturbance has coefficients k^-3 or k^-2. For elastic contact its tail adds N^-3 to the force
  at each end of a contact, which the error of the end's own place undoes: both are r1 (1 + 1/rm)/pi
  times the sum of k^-4 beyond N, with opposite signs. With the dashpot the terms of k and -k
  cancel. The Floquet multipliers err by N^-4 or N^-3.

These hold from `asymptotic_harmonic` on, and errors oscillate about them: entry and exit of a
contact add with a phase between them that turns with N. Without contacts the motion is analytic
in a strip around the real time axis, up to its nearest singularity at a distance s. The omitted
harmonics fall as exp(-s W N), and the last retained ones err by as much times N^-2; the
multipliers, where two tails meet, err by exp(-2 s W N).
"""

import numpy as np
from scipy.integrate import solve_ivp

from impact_damper.system.packed import DAMPING, FREQUENCY, STIFFNESS

# Of max |Z1|; root mean square of Z1 in the harmonics up to N, and beyond; of a multiplier.
MEASURES = ("maximum", "retained", "omitted", "multiplier")
ELASTIC = (4.0, 5.0, 3.5, 4.0)
INELASTIC = (3.0, 3.0, 2.5, 3.0)
ANALYTIC = (1.0, 1.0, 1.0, 2.0)
STARTS = 12
LARGE = 30.0
CLOSE = 0.95


def asymptotic_harmonic(damper, frequency) -> float:
    """Harmonic from which on the powers can hold; 1 without a damper.

    Its wavelength is one contact, which without other forces lasts pi/(w sqrt(1 - z^2)) with
    w^2 = r1 (1 + 1/rm) and z = zc sqrt(1 + rm) (appendix B). With a dashpot it is at least
    r1/(c W), c = 2 zc sqrt(r1 rm): the jump c Z2' of the force outweighs the kink r1 Z2' beyond.
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
    """How errors fall, "algebraic" or "exponential", and the powers or rates of `MEASURES`.

    Parameters
    ----------
    damper : Damper or None
    p : array, shape (packed.COUNT,)
        Packed parameters.
    state : array, shape (4,)
        A state of the exact orbit at W T = pi/2.
    """
    if damper is None:
        return "exponential", np.array(ANALYTIC) * p[FREQUENCY] * singularity_distance(p, state)
    return "algebraic", np.array(ELASTIC if damper.restitution == 1 else INELASTIC)


def singularity_distance(p, state) -> float:
    """Distance of the nearest singularity of a free motion, in complex time, from the real axis.

    The motion is integrated up from points of the real axis over half a forcing period. Near a
    singularity Z1 is sqrt(-2)/(T - T*), so Z1/Z1' tells how far away it is; then it is approached
    from straight below. NaN if none is found.

    Parameters
    ----------
    p, state
        As in `decay`.
    """

    def rates(time, y):
        x, v = y
        drive = np.cos(p[FREQUENCY] * time)
        return np.array([v, drive - p[DAMPING] * v - p[STIFFNESS] * x - x**3])

    def carry(y, begin, end):
        """State at a complex time on the straight line from another, or where Z1 grows large."""

        def large(share, y):
            return LARGE - abs(y[0])

        large.terminal = True
        run = solve_ivp(
            lambda share, y: (end - begin) * rates(begin + share * (end - begin), y),
            (0, 1),
            y.astype(complex),
            method="DOP853",
            events=large,
            rtol=1e-10,
            atol=1e-12,
        )
        return begin + run.t[-1] * (end - begin), run.y[:, -1]

    begin = 0.5 * np.pi / p[FREQUENCY]
    heights = []
    for lag in np.pi / p[FREQUENCY] * np.arange(STARTS) / STARTS:
        _, real = carry(state[:2], begin, begin + lag)
        time, y = carry(real, begin + lag, begin + lag + 1j * np.pi / p[FREQUENCY])
        for _ in range(8):
            before, place = time, time + y[0] / y[1]
            if not 0 < place.imag < 2 * np.pi / p[FREQUENCY]:
                break
            _, real = carry(state[:2], begin, place.real)
            time, y = carry(real, complex(place.real), place.real + 1j * CLOSE * place.imag)
            if abs(time - before) < 1e-6:
                heights.append(place.imag)
                break
    return float(min(heights, default=np.nan))
