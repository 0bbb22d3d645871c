"""Times of imports, of compilation and of a first result, each in a new process.

Kernels are the functions of the package that numba compiles.
"""

import os
import subprocess
import sys
import tempfile
import time

import pandas as pd

SYSTEM = "idm.Oscillator(0.215), idm.Damper(0.12, 2.0), 2.0, (1, 0.5, 0, 0)"
FIRST = {
    "simulate": f"import impact_damper as idm; idm.simulate({SYSTEM}, periods=50)",
    "steady_motion": f"import impact_damper as idm; idm.steady_motion({SYSTEM})",
}
ALL = (
    "from impact_damper.command.warm_up import warm_up_orbits, warm_up_settling; "
    "warm_up_orbits(); warm_up_settling()"
)
IMPORTS = ("numpy", "numba", "xarray", "scipy.integrate", "matplotlib.figure", "impact_damper")


def seconds_of(code, cache):
    """Return the seconds that a new process takes for a line of Python; `cache` keeps kernels."""
    begin = time.perf_counter()
    environment = os.environ | {"NUMBA_CACHE_DIR": cache}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
    return time.perf_counter() - begin


def table(repeats, compiling=True):
    """Return the seconds to start Python, to import, and to a first result.

    Parameters
    ----------
    repeats : int
        Number of processes, of which the fastest counts, for each time without compilation.
    compiling : bool
        Whether first results are measured, with an empty and with a full cache of kernels.
    """
    rows = []

    def row(what, seconds):
        print(f"  {what}: {seconds:.2f} s", flush=True)
        rows.append({"what": what, "seconds": seconds})

    with tempfile.TemporaryDirectory(prefix="impact-damper-") as cache:
        row("Python alone", min(seconds_of("pass", cache) for _ in range(repeats)))
        for name in IMPORTS:
            row(f"import {name}", min(seconds_of(f"import {name}", cache) for _ in range(repeats)))
    if not compiling:
        return pd.DataFrame(rows)
    for name, code in FIRST.items():
        with tempfile.TemporaryDirectory(prefix="impact-damper-") as cache:
            row(f"first {name}, no kernel compiled yet", seconds_of(code, cache))
            seconds = min(seconds_of(code, cache) for _ in range(repeats))
            row(f"first {name}, kernels compiled", seconds)
    with tempfile.TemporaryDirectory(prefix="impact-damper-") as cache:
        row("every kernel, none compiled yet", seconds_of(ALL, cache))
        row("every kernel, all compiled", seconds_of(ALL, cache))
    return pd.DataFrame(rows)
