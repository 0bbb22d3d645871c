"""Find the ends of the stability of symmetric motions with two impacts in a forcing cycle.

The motions are those of `masri_caughey`. Z1 is the displacement of the primary mass, and W the
forcing frequency. For each ratio s = w/d0 of the speed w of the loose mass to the clearance d0
there is one motion. Ranges of s with stable motions are found on a grid, and the ends of these
ranges by bisection.
"""

from typing import NamedTuple

import numpy as np

from chatterjee1995.comparisons.masri_caughey import Family, TwoImpactMotion

# Grid of the ratio pi w/(2 W d0) on which stability is computed. The ratio is 1 if Z1 = 0 at the
# impacts. Above the last value the motion is unstable for any damper.
RATIOS = np.linspace(0.02, 2.5, 249)
# Number of bisections that locate a change of stability.
BISECTIONS = 48
# A multiplier counts as complex if the modulus of its imaginary part exceeds COMPLEX.
COMPLEX = 1e-6


class Boundary(NamedTuple):
    """End of a range of clearances in which a motion with two impacts is stable.

    Attributes
    ----------
    motion : TwoImpactMotion
        The motion at this end of the range.
    event : str
        The event at which the motion loses stability: "fold", "symmetry_breaking",
        "neimark_sacker", or "third_contact" if the loose mass begins to touch a wall in a flight.
    """

    motion: TwoImpactMotion
    event: str


def stability_boundaries(oscillator, damper, frequency) -> list[Boundary]:
    """Return the clearances at which symmetric motions with two impacts gain or lose stability.

    Parameters
    ----------
    oscillator, damper, frequency
        As in `two_impact_motions`, but the clearance of the damper has no effect.

    Returns
    -------
    list of Boundary
        By ascending ratio s.
    """
    family = Family(oscillator, damper, frequency)
    ratios = RATIOS * 2 * family.frequency / np.pi
    stable = np.array([family.is_stable(ratio) for ratio in ratios])
    boundaries = []
    for k in np.flatnonzero(stable[:-1] != stable[1:]):
        inner, outer = ratios[k : k + 2][:: 1 if stable[k] else -1]
        for _ in range(BISECTIONS):
            middle = (inner + outer) / 2
            inner, outer = (middle, outer) if family.is_stable(middle) else (inner, middle)
        motion = family.motion(inner)
        boundaries.append(Boundary(motion, _event(motion)))
    return boundaries


def _event(motion):
    """Return the event at which stability is lost, from the last stable motion."""
    value = motion.multipliers[0]
    if motion.room < 1 - abs(value):
        return "third_contact"
    if abs(value.imag) > COMPLEX:
        return "neimark_sacker"
    return "fold" if value.real > 0 else "symmetry_breaking"
