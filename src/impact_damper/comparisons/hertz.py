"""Hertz's impact of elastic bodies against our contact with the linear spring of equal energy."""

import numpy as np

from impact_damper.comparisons.comparison import Comparison
from impact_damper.machine.hertz import HertzContact, Material
from impact_damper.motions.simulate import simulate
from impact_damper.system.parameters import Damper, Oscillator

STEEL = Material(youngs_modulus=210e9, poissons_ratio=0.3)
# Masses of the machine and of a steel ball with its radius, kg and m; half its gap, mm.
MACHINE, BALL, RADIUS, HALF_GAP = 12.0, 0.6, 0.0264, 1.0
# Distance from the wall at which the impact is simulated, over half the gap, and samples of it.
APART, SAMPLES = 1e-6, 4000
# A forcing frequency, 1/s, in whose period the impact ends; there is no force.
FREQUENCY = 1000.0
UNDAMPED = 1e-9


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
    found = []
    for speed in speeds:
        hertz = contact.impact(speed, mass)
        duration, compression = _simulated(hertz.stiffness, speed)
        rows = {
            "duration of impact in microseconds": (1e6 * hertz.duration, 1e6 * duration),
            "largest compression in micrometres": (1e6 * hertz.compression, 1e6 * compression),
            "largest force in kN": (1e-3 * hertz.force, 1e-3 * hertz.stiffness * compression),
        }
        for quantity, (published, ours) in rows.items():
            words = f"{quantity}, steel ball of {1e3 * RADIUS:g} mm radius at {speed:g} m/s"
            found.append(
                Comparison("hertz", words, float(published), float(ours), "linear_contact")
            )
    return found


def _simulated(stiffness, speed):
    """Return duration in s and largest compression in m of a simulated impact; it runs in mm, s."""
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
