"""Frequencies at which the forced motion of a weakly damped Duffing oscillator jumps.

The closed forms are from Brennan, Kovacic, Carrella and Waters, "On the jump-up and jump-down
frequencies of the Duffing oscillator", J. Sound Vib. 318(4-5), 1250-1261, 2008. The authors apply
single-term harmonic balance to x'' + 2 z x' + x + a x^3 = F cos(r T), with a hardening (a > 0) or
softening (a < 0) spring. The amplitude X of the motion solves

    ((1 - r^2) X + (3/4) a X^3)^2 + (2 z r X)^2 = F^2.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.model.bounds import check_number, plain


class Jumps(NamedTuple):
    """Frequencies of the two folds of the response.

    Attributes
    ----------
    down : float
        Frequency r of the jump from the large to the small motion. It is approximated by the
        frequency of the largest response, r^2 = (1 + sqrt(1 + 3 a F^2/(4 z^2)))/2, at which the
        motion lags the force by a quarter of a cycle. The error is of second order in z.
    up : float
        Frequency r of the jump from the small to the large motion, without damping:
        r^2 = 1 + (3/2)^(4/3) (a F^2)^(1/3).
    """

    down: float
    up: float


def jumps(damping_ratio, cubic, force) -> Jumps:
    """Return the jump frequencies in closed form.

    Parameters
    ----------
    damping_ratio, cubic, force : float
        z, a and F, dimensionless.

    Raises
    ------
    TypeError, ValueError
        If a value is out of range, or if the spring is so soft that the response has no maximum:
        a < 0 and 3 |a| F^2 > 4 z^2.
    """
    check_number("damping_ratio", damping_ratio, above=0.0, most=1.0)
    check_number("cubic", cubic)
    check_number("force", force, above=0.0)
    inner = 1 + 3 * cubic * force**2 / (4 * damping_ratio**2)
    if inner < 0:
        raise ValueError(
            f"cubic = {plain(cubic)}: must be at least -4 z^2/(3 F^2) = "
            f"{-4 * damping_ratio**2 / (3 * force**2):g} (the response has no maximum)"
        )
    down = np.sqrt((1 + np.sqrt(inner)) / 2)
    return Jumps(down, np.sqrt(1 + 1.5 ** (4 / 3) * np.cbrt(cubic * force**2)))
