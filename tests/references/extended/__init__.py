"""Motions in 80-bit arithmetic by a C program that shares no code with the package.

The package's own integrators are called kernels. State and parameters are the same as theirs:
(Z1, Z1', Z2, Z2') and the array from `model.packed.pack`. The program uses Taylor series of order
32 with a local error of 1e-20, and isolates events (beginnings and ends of contacts) by the signs
of Bernstein coefficients (see motion.c). The compiler `cc` compiles the program on first use, in
about half a second.
"""

import ctypes
import functools
import math
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from impact_damper.model.packed import NAMES

PROGRAM = Path(__file__).with_name("motion.c")
STATUS = {1: "a log is full", 2: "too many steps"}
Real = np.longdouble


def obstacle():
    """Return the reason why the program cannot run on this computer, or an empty string."""
    if np.finfo(Real).nmant < 63:
        return "long double has no more digits than double here"
    if shutil.which("cc") is None:
        return "no C compiler `cc`"
    return ""


@functools.cache
def _library():
    """Return the compiled program, or raise RuntimeError with the text of `obstacle`."""
    if obstacle():
        raise RuntimeError(obstacle())
    (members,) = re.findall(r"real ([\w,\s]*);\n} Parameters;", PROGRAM.read_text())
    if tuple(re.findall(r"\w+", members.upper())) != NAMES:
        raise RuntimeError(
            "tests/references/extended/motion.c: the members of Parameters must be those of "
            f"packed.NAMES, in lower case: {', '.join(NAMES)}"
        )
    with tempfile.TemporaryDirectory(prefix="impact-damper-") as folder:
        library = Path(folder) / "motion.so"
        command = ["cc", "-O2", "-std=c11", "-shared", "-fPIC", "-o", library, PROGRAM, "-lm"]
        subprocess.run(command, check=True)
        loaded = ctypes.CDLL(str(library))
    real, plain, whole = (
        np.ctypeslib.ndpointer(kind, flags="C") for kind in (Real, float, np.int64)
    )
    count, number = ctypes.c_long, ctypes.c_longdouble
    loaded.motion.argtypes = [plain, real, number, real, count, real, count, *[real] * 7, whole]
    return loaded


class Run(NamedTuple):
    """One motion; all arrays are long double.

    Attributes
    ----------
    states : array, shape (n, 4)
        State at each requested time.
    extremes : array, shape (n, 2)
        Smallest and largest Z1 since the requested time before, or since the first state.
    contacts : array, shape (k, 5)
        Wall, beginning, end, and Z2' at both; NaN for a contact that has not ended. If the first
        state is in contact, this contact is the first row and begins at the first state.
    begun : int
        Number of contacts that begin in the run; a contact of the first state is not counted.
    turnings : array, shape (m, 4)
        Extrema of Z2, in contact or in flight, and the last Z2. A row holds the time, the nearest
        wall, the height of Z2 beyond this wall (negative inside the gap), and the largest factor by
        which an error of the state at an earlier instant grows to an error of Z2. Empty without
        walls.
    flow : array, shape (4, 4)
        Derivative of the last state with respect to the first state.
    growth : long double
        Largest norm of the derivative of the last state with respect to the state at an instant of
        the run, at least 1. Instants are the first time, the requested times and the events (after
        the jump of the derivative). The norm is the largest sum of moduli in a row.
    """

    states: np.ndarray
    extremes: np.ndarray
    contacts: np.ndarray
    begun: int
    turnings: np.ndarray
    flow: np.ndarray
    growth: Real

    @property
    def margin(self):
        """An error of this size could change the number of contacts."""
        return np.min(np.abs(self.turnings[:, 2]) / self.turnings[:, 3], initial=np.inf)


def run(p, state, start, times, *, tolerance=1e-20, longest=math.inf, room=100_000):
    """Return the `Run` from the time `start` through increasing `times`.

    Parameters
    ----------
    p : array, shape (COUNT,)
        Packed parameters.
    state : array, shape (4,)
        First state. It is in contact if it lies beyond a wall, or on a wall with outward velocity.
    start : float or long double
    times : array, shape (n,)
    tolerance, longest : float
        Local error of a step, relative to the state if this is larger than 1; longest step.
    room : int
        Largest number of contacts, of extrema of Z2, and of instants.

    Raises
    ------
    RuntimeError
        If the program cannot be compiled on this computer, or if `room` is too small.
    """
    times = np.atleast_1d(np.asarray(times, Real))
    n, counts = len(times), np.empty(3, np.int64)
    shapes = (n, 4), (n, 2), (room, 5), (room, 4), (room, 16), (4, 4), (1,)
    made = [np.empty(shape, Real) for shape in shapes]
    settings = np.array([tolerance, longest], Real)
    given = np.array(p, float), np.array(state, Real), start, times, n, settings, room
    status = _library().motion(*given, *made, counts)
    if status:
        raise RuntimeError(f"80-bit motion: {STATUS[status]}")
    states, extremes, contacts, turnings, _, flow, (growth,) = made
    begun, logged, turned = counts
    return Run(
        states,
        extremes,
        contacts[:logged].copy(),
        int(begun),
        turnings[:turned].copy(),
        flow,
        growth,
    )
