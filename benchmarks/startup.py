"""Start-up and compile times, each in a process of its own."""

import os
import subprocess
import sys
import tempfile
import time

import pandas as pd

FIRST = (
    "import impact_damper as idm;"
    "idm.simulate(idm.Oscillator(0.215), idm.Damper(0.12, 2.0), 2.0, (1, 0.5, 0, 0), periods=50)"
)
ALL = "from impact_damper.workflow.compile_kernels import warm_up; warm_up()"
IMPORTS = ("numpy", "numba", "xarray", "scipy.integrate", "matplotlib.figure", "impact_damper")


def seconds_of(code, cache):
    """Seconds that a new process takes to run a line of Python with a cache of kernels."""
    begin = time.perf_counter()
    environment = os.environ | {"NUMBA_CACHE_DIR": cache}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
    return time.perf_counter() - begin


def table(repeats, compiling=True):
    """Seconds to start, import, compile and give a first result; the least of some repeats.

    Parameters
    ----------
    repeats : int
        Of what does not compile.
    compiling : bool
        Whether to measure with an empty cache too.
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
        row("first motion, no kernel compiled yet", seconds_of(FIRST, cache))
        row("first motion, kernels compiled", min(seconds_of(FIRST, cache) for _ in range(repeats)))
    with tempfile.TemporaryDirectory(prefix="impact-damper-") as cache:
        row("every kernel, none compiled yet", seconds_of(ALL, cache))
        row("every kernel, all compiled", seconds_of(ALL, cache))
    return pd.DataFrame(rows)
