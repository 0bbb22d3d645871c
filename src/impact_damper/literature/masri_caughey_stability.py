"""Ends of the stability of symmetric motions with two impacts a period (see `masri_caughey`).

Along the ratio s = w/d0 of the speed of the loose mass to half the gap there is one motion for each
s. The ranges of s with stable motions are searched for on a grid, and their ends by bisection.
"""

from typing import NamedTuple

import numpy as np

from impact_damper.literature.masri_caughey import Family, TwoImpactMotion

# Grid of the ratio pi w/(2 W d0) on which changes of stability are looked for. The ratio is 1 if
# the primary mass is in its middle position at the impacts. Beyond the last value the motion is
# unstable for any damper.
RATIOS = np.linspace(0.02, 2.5, 249)
# Bisections with which a change of stability is located.
BISECTIONS = 48
# A multiplier counts as complex if the modulus of its imaginary part exceeds this.
COMPLEX = 1e-6


class Boundary(NamedTuple):
    """End of a range of clearances in which a motion with two impacts is stable.

    Attributes
    ----------
    motion : TwoImpactMotion
        The motion at this end of the range.
    event : str
        What ends stability: "fold", "symmetry_breaking", "neimark_sacker", or "third_contact" if
        the loose mass begins to touch a wall during a flight.
    """

    motion: TwoImpactMotion
    event: str


def stability_boundaries(oscillator, damper, frequency) -> list[Boundary]:
    """Return the clearances at which symmetric motions with two impacts gain or lose stability.

    Parameters
    ----------
    oscillator, damper, frequency
        As of `two_impact_motions`; the clearance of the damper has no effect.

    Returns
    -------
    list of Boundary
        By rising ratio of the speed of the loose mass to the clearance.
    """
    family = Family(oscillator, damper, frequency)
    ratios = RATIOS * 2 * family.frequency / np.pi
    stable = np.array([family.is_stable(ratio) for ratio in ratios])
    found = []
    for k in np.flatnonzero(stable[:-1] != stable[1:]):
        inner, outer = ratios[k : k + 2][:: 1 if stable[k] else -1]
        for _ in range(BISECTIONS):
            middle = (inner + outer) / 2
            inner, outer = (middle, outer) if family.is_stable(middle) else (inner, middle)
        motion = family.motion(inner)
        found.append(Boundary(motion, _event(motion)))
    return found


def _event(motion):
    """Return the event that ends stability, given the last stable motion."""
    value = motion.multipliers[0]
    if motion.room < 1 - abs(value):
        return "third_contact"
    if abs(value.imag) > COMPLEX:
        return "neimark_sacker"
    return "fold" if value.real > 0 else "symmetry_breaking"
