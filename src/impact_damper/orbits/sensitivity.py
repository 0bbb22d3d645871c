"""Derivatives of periodic orbits by their parameters."""

import numpy as np

from impact_damper.orbits.shooting import newton, shoot

# Changes of an orbit for differences, as fractions of the direction.
NUDGE = 1e-4
# A size has a kink if its relative slopes on both sides differ by more than this, or by more than
# this share of a slope above 1.
KINK = 0.02


def relative_slopes(orbit, direction) -> np.ndarray:
    """Return the derivatives of ln max |Z1| and of ln |largest multiplier| along a direction.

    They are central differences between orbits with other packed parameters, NaN at a kink or where
    no orbit is found.
    """
    sizes = []
    for share in (-NUDGE, 0.0, NUDGE):
        near = newton(shoot(orbit.p + share * direction, orbit.state, orbit.periods, orbit.phase))
        sizes.append([near.record["maximum_displacement"], abs(near.multipliers[0])])
        if not near.converged:
            return np.full(2, np.nan)
    behind, here, ahead = np.log(sizes)
    kinks = np.abs(ahead - 2 * here + behind) > KINK * np.maximum(NUDGE, np.abs(ahead - behind) / 2)
    return np.where(kinks, np.nan, (ahead - behind) / (2 * NUDGE))
