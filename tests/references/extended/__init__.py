"""Motions in 80-bit arithmetic by a C program that shares no code with the package.

As for kernels, the state is (Z1, Z1', Z2, Z2') and the parameters are the array from
`model.packed.pack`. The program uses Taylor series of order 32 with a local error of 1e-20, and
isolates events (beginnings and ends of contacts) by the signs of Bernstein coefficients (see
motion.c). The compiler `cc` compiles the program on first use.
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

    `states`, shape (n, 4), are at the requested times. `extremes`, shape (n, 2), are the smallest
    and largest Z1 since the time before. `contacts`, shape (k, 5): wall, begin, end, Z2' at the
    begin, Z2' at the end (NaN before the end). `begun` is the number of contacts that begin after
    the start. `turnings`, shape (m, 4), has a row for each extremum of Z2 and for the last Z2:
    time, nearest wall, height of Z2 beyond this wall (negative inside the gap), and the largest
    factor by which an error of an earlier state grows to an error of Z2. `flow` is the derivative
    of the last state by the first. `growth` is the largest norm, at least 1, of the derivative of
    the last state by the state at a requested time or an event.
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
        """Smallest error that could change the number of contacts."""
        return np.min(np.abs(self.turnings[:, 2]) / self.turnings[:, 3], initial=np.inf)


def run(p, state, start, times, *, tolerance=1e-20, longest=math.inf, room=100_000):
    """Return the `Run` from the time `start` through increasing times.

    The first state is in contact if it lies beyond a wall, or on a wall with outward velocity.
    `tolerance` is the local error of a step, relative to the state if the state exceeds 1, and
    `longest` the longest step. `room` is the largest number of contacts, and of extrema of Z2. A
    RuntimeError says that `room` is too small, or that the program cannot be compiled.
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
