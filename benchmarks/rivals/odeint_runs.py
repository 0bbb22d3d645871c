"""Boost.odeint, from C++ (`odeint.cpp`), compiled on first use with `c++ -O3 -march=native`."""

import ctypes
import functools
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from benchmarks.rivals import coefficients
from impact_damper.model.packed import BASE, FRICTION, GRAVITY, LAG

PROGRAM = Path(__file__).with_name("odeint.cpp")
FLAGS = ("-O3", "-march=native", "-std=c++17", "-shared", "-fPIC")


def obstacle():
    if shutil.which("c++") is None:
        return "no C++ compiler `c++`"
    test = ["c++", "-E", "-x", "c++", "-include", "boost/numeric/odeint.hpp", "/dev/null"]
    if subprocess.run(test, capture_output=True).returncode:
        return "no Boost (Debian: libboost-dev)"
    return ""


def version():
    read = ["c++", "-E", "-P", "-x", "c++", "-include", "boost/version.hpp", "-"]
    boost = subprocess.run(read, input="BOOST_LIB_VERSION", capture_output=True, text=True)
    compiler = subprocess.run(["c++", "--version"], capture_output=True, text=True)
    return f"Boost {boost.stdout.split()[-1]}, {compiler.stdout.splitlines()[0]}"


@functools.cache
def _library():
    with tempfile.TemporaryDirectory(prefix="impact-damper-") as folder:
        library = Path(folder) / "odeint.so"
        subprocess.run(["c++", *FLAGS, "-o", library, PROGRAM], check=True)
        loaded = ctypes.CDLL(str(library))
    real = np.ctypeslib.ndpointer(float, flags="C")
    whole = np.ctypeslib.ndpointer(np.int64, flags="C")
    number = ctypes.c_double
    loaded.motions.restype = loaded.largest.restype = None
    loaded.motions.argtypes = [real, ctypes.c_long, number, number, number, real, whole]
    loaded.largest.argtypes = [real, ctypes.c_long, *[number] * 4, real, real]
    return loaded


def largest(p, states, begin, lead, end, tolerance) -> np.ndarray:
    """Return the largest displacement of each motion from the time `lead` to `end`."""
    sizes = np.empty(len(states))
    states = np.ascontiguousarray(states)
    _library().largest(_given(p), len(states), begin, lead, end, tolerance, states, sizes)
    return sizes


def _given(p):
    """Return the members of Motion in the program; Motion has no friction."""
    assert p[FRICTION] == 0
    return np.array([*coefficients(p), p[LAG], p[BASE], p[GRAVITY]])


def prepare(scene, tolerance):
    given, library = _given(scene.parameters), _library()

    def run(starts):
        states, contacts = np.array(starts), np.zeros(len(starts), np.int64)
        library.motions(given, len(starts), scene.begin, scene.end, tolerance, states, contacts)
        return states, contacts

    return run
