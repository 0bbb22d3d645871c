"""The symmetric motion of Masri and Caughey, compared with orbits for increasing contact stiffness.

In this motion the loose mass meets each wall once in a forcing cycle, and half a cycle later the
motion is the mirror image. The closed form of Masri and Caughey holds for rigid walls. The orbits
of this package have contacts of finite stiffness r1.

W is the forcing frequency, d0 the clearance and rm the mass ratio.
"""

from dataclasses import replace
from itertools import product

import numpy as np

from chatterjee1995.comparisons.comparison import Comparison, observed_order
from chatterjee1995.comparisons.masri_caughey import two_impact_motions
from chatterjee1995.comparisons.masri_caughey_stability import stability_boundaries
from chatterjee1995.comparisons.symmetric_orbits import boundary_near, orbit_at_clearance
from impact_damper.model.checks import check_increasing
from impact_damper.model.parameters import Damper, Oscillator

# Exponent n of the difference r1^n between compliant and rigid walls. The computed numbers are
# extrapolated to rigid walls with this exponent.
ORDER = -0.5
# Events at which a motion loses stability, and their names in `Comparison.quantity`.
EVENTS = {
    "fold": "fold",
    "symmetry_breaking": "loss of symmetry",
    "neimark_sacker": "torus",
}


def rigid_walls(damping_ratio, restitutions, mass_ratios, gaps, frequencies, stiffnesses):
    """Compare displacements, Floquet multipliers, and gaps at which stability is lost.

    The comparisons are made for all combinations of the values in the sequences.

    Parameters
    ----------
    damping_ratio : float
        Damping ratio of the oscillator. Its linear stiffness, force and natural frequency are 1, so
        the unit of length is the static deflection.
    restitutions, mass_ratios, gaps, frequencies : sequence of float
        e, rm, gap 2 d0 and W.
    stiffnesses : sequence of float
        Two or more increasing contact stiffnesses r1. The order of convergence and the limit for
        rigid walls are estimated from the last two.

    Returns
    -------
    list of Comparison
        For each combination the comparisons of the stable motion or, if no motion is stable, of the
        motion whose largest multiplier is smallest. A combination for which the closed form has no
        motion adds no comparison.

    Raises
    ------
    ArithmeticError
        If no orbit is found although the closed form has a motion.
    TypeError, ValueError
        If a value is out of range, or the stiffnesses do not increase.
    """
    stiffnesses = check_increasing("stiffnesses", stiffnesses, "two").tolist()
    comparisons = []
    oscillator = Oscillator(2 * damping_ratio, 1.0, cubic=0.0, force=1.0)
    for restitution, mass, frequency in product(restitutions, mass_ratios, frequencies):
        words = f"e = {restitution:g}, rm = {mass:g}, W = {frequency:g}"
        dampers = [Damper(mass, 1.0, restitution, stiffness) for stiffness in stiffnesses]
        for gap in gaps:
            comparisons += _at_gap(oscillator, dampers, frequency, gap / 2, words)
        for boundary in stability_boundaries(oscillator, dampers[0], frequency):
            if boundary.event in EVENTS:
                ours = [boundary_near(oscillator, each, frequency, boundary) for each in dampers]
                comparisons.append(
                    _compared(
                        f"gap at the {EVENTS[boundary.event]}, {words}",
                        2 * boundary.motion.clearance,
                        [2 * each.clearance for each in ours],
                        stiffnesses,
                    )
                )
    return comparisons


def _at_gap(oscillator, dampers, frequency, clearance, words):
    """Return comparisons at one clearance: of the displacement and, if stable, the multiplier.

    `dampers` has one damper for each contact stiffness, and `words` names the other parameters. If
    the closed form has several motions, the one with the smallest multiplier is compared.
    """
    dampers = [replace(each, clearance=clearance) for each in dampers]
    motions = [x for x in two_impact_motions(oscillator, dampers[0], frequency) if x.room > 0]
    if not motions:
        return []
    motion = min(motions, key=lambda each: abs(each.multipliers[0]))
    ours = [orbit_at_clearance(oscillator, each, frequency, motion) for each in dampers]
    stiffnesses = [each.contact_stiffness for each in dampers]
    kind = "stable" if motion.stable else "unstable"
    words = f"gap {2 * clearance:g}, {words} ({kind})"
    sizes = [each.displacement for each in ours]
    comparisons = [_compared(f"max |Z1|, {words}", motion.displacement, sizes, stiffnesses)]
    if motion.stable:
        values = [each.modulus for each in ours]
        name, value = f"largest multiplier, {words}", abs(motion.multipliers[0])
        comparisons.append(_compared(name, value, values, stiffnesses))
    return comparisons


def _compared(quantity, published, ours, stiffnesses):
    """Return the comparison of `ours`, one number for each stiffness, with the published number.

    The limit for rigid walls is extrapolated from the last two numbers, which differ from it by
    c r1^ORDER with an unknown constant c.
    """
    ours = np.array(ours)
    gain = (stiffnesses[-1] / stiffnesses[-2]) ** -ORDER - 1
    limit = float(ours[-1] + (ours[-1] - ours[-2]) / gain)
    return Comparison(
        "masri_caughey",
        quantity,
        float(published),
        float(ours[-1]),
        "contact_stiffness",
        order=observed_order(stiffnesses, ours - published),
        limit=limit,
        expected=abs(float(ours[-1]) - limit) / abs(limit),
    )
