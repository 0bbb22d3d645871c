"""Motions of dampers as they are built, by a C program that shares no code with the library."""

import ctypes
import functools
import math
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

import impact_damper as idm

PROGRAM = Path(__file__).with_name("built.c")
# A machine on a moving base, whose spring hardens.
BOARD = idm.Machine(
    mass=12,
    linear_stiffness=2e5,
    cubic_stiffness=5e8,
    damping_ratio=0.01,
    base_displacement="0.2 mm",
)


@functools.cache
def program():
    with tempfile.TemporaryDirectory(prefix="impact-damper-") as folder:
        library = Path(folder) / "built.so"
        command = ["cc", "-O2", "-std=c11", "-shared", "-fPIC", "-o", library, PROGRAM, "-lm"]
        subprocess.run(command, check=True)
        found = ctypes.CDLL(str(library)).largest
    row = np.ctypeslib.ndpointer(float, flags="C")
    found.argtypes, found.restype = [row, row, *[ctypes.c_double] * 5], ctypes.c_double
    return found


def dashpot(restitution):
    """Return the damping ratio z for e = exp(-(pi - 2 a) tan a), z = sin a."""
    logarithm = math.log(restitution)
    return math.sin(brentq(lambda a: (math.pi - 2 * a) * math.tan(a) + logarithm, 0, 1.5))


def by_program(machine, damper, hertz, state, cycles, lead, steps=120, start=0.0):
    """Return the largest displacement, m, from a state in SI units on.

    The run begins at the phase `start` of the forcing, in cycles. `lead` cycles are not measured.
    """
    angular = 2 * math.pi * hertz
    reduced = machine.mass * damper.mass / (machine.mass + damper.mass)
    natural = math.sqrt(damper.contact_stiffness / reduced)
    given = [
        machine.mass,
        2 * machine.damping_ratio * math.sqrt(machine.linear_stiffness * machine.mass),
        machine.linear_stiffness,
        machine.cubic_stiffness,
        machine.force or 0.0,
        (machine.base_displacement or 0.0) * angular**2,
        damper.mass,
        damper.gap / 2,
        damper.contact_stiffness,
        2 * dashpot(damper.restitution) * natural * reduced,
        damper.gravity,
        damper.friction,
        angular,
    ]
    begin, end = (start + lead) / hertz, (start + cycles) / hertz
    times = start / hertz, begin, end, 1 / (steps * hertz), 30 / (steps * natural)
    return program()(np.array(given), np.array(state, float), *times)
