"""Hertz's impact of elastic bodies, compared with the linear contact spring of this package.

The linear spring stores the same energy at the largest compression as the contact by Hertz's
theory.
"""

import numpy as np

from chatterjee1995.comparisons.comparison import Comparison
from impact_damper.model.hertz import DURATION, HertzContact, Material
from impact_damper.model.parameters import Damper, Oscillator
from impact_damper.motions.simulate import simulate

STEEL = Material(youngs_modulus=210e9, poissons_ratio=0.3)
# MACHINE and BALL: masses of the machine and of the steel ball, kg. RADIUS: radius of the ball, m.
# HALF_GAP: clearance of the ball in the machine, mm.
MACHINE, BALL, RADIUS, HALF_GAP = 12.0, 0.6, 0.0264, 1.0
# APART: distance of the ball from the wall at the beginning of a simulation, divided by HALF_GAP.
# SAMPLES: number of states stored in a forcing cycle.
APART, SAMPLES = 1e-6, 4000
# Forcing frequency, rad/s. The force is zero, so the frequency only determines the length of the
# run, half a forcing cycle.
FREQUENCY = 1000.0
# Damping h of the machine, the smallest that `Oscillator` allows; 0 is not allowed.
UNDAMPED = 1e-9
# Differences expected from theory between an impact on the linear spring and one by Hertz's theory.
# LONGER: relative increase of the duration, which is pi compression/speed on the linear spring and
#     DURATION compression/speed by Hertz's theory.
# WEAKER: relative decrease of the largest force. At the same energy and compression the force is 2
#     energy/compression on the linear spring and 5/2 energy/compression by Hertz's theory.
LONGER, WEAKER = np.pi / DURATION - 1, 1 / 5


def hertz_impacts(speeds):
    """Compare duration, compression and force of the impact of a steel ball in a machine.

    Parameters
    ----------
    speeds : sequence of float
        Relative speeds before the impact, m/s.

    Returns
    -------
    list of Comparison
    """
    contact = HertzContact(radius=RADIUS, loose=STEEL)
    mass = BALL * MACHINE / (BALL + MACHINE)
    comparisons = []
    for speed in speeds:
        hertz = contact.impact(speed, mass)
        duration, compression = _simulated(hertz.stiffness, speed)
        rows = {
            "duration of impact in microseconds": (1e6, hertz.duration, duration, LONGER),
            "largest compression in micrometres": (1e6, hertz.compression, compression, np.nan),
            "largest force in kN": (1e-3, hertz.force, hertz.stiffness * compression, WEAKER),
        }
        for quantity, (unit, published, ours, expected) in rows.items():
            words = f"{quantity}, steel ball of {1e3 * RADIUS:g} mm radius at {speed:g} m/s"
            numbers = float(unit * published), float(unit * ours)
            comparisons.append(
                Comparison("hertz", words, *numbers, "linear_contact", expected=expected)
            )
    return comparisons


def _simulated(stiffness, speed):
    """Return duration (s) and largest compression (m) of a simulated impact on the linear spring.

    `stiffness` is in N/m and `speed` in m/s. The simulation uses the units mm and s.
    """
    motion = simulate(
        Oscillator(UNDAMPED, 0.0, cubic=0.0, force=0.0),
        Damper(BALL / MACHINE, HALF_GAP, 1.0, stiffness / MACHINE),
        FREQUENCY,
        (0.0, 0.0, HALF_GAP * (1 - APART), 1e3 * speed),
        periods=0.5,
        samples=SAMPLES,
    )
    duration = float(motion["contact_end"][0] - motion["contact_begin"][0])
    compression = np.max(motion["relative_displacement"].values) - HALF_GAP
    return duration, 1e-3 * compression
