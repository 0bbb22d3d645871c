"""A call by address gives the result of a direct call, and a failure to compile raises."""

import os
import subprocess
import sys

import numpy as np
from helpers.pointed import pointed

from impact_damper.kernel.compiling import by_address, kernel


@kernel
def add(a, d):
    """Add the number at d to the number at a."""
    for i in range(2):
        a[i] += d[i]


called = by_address(add)

# A module with a kernel that calls another kernel by address.
MODULE = """
import numpy as np
from impact_damper.kernel.compiling import by_address, kernel, kernel_only, pointer

@kernel_only
def increment(x):
    return x + 1.0

@kernel
def add(a):
    a[0] = increment(a[0])

called = by_address(add)

@kernel
def twice(a):
    called(pointer(a))
    called(pointer(a))
    return a[0]
"""

USE = """
import numpy as np
import module_of_kernels as module
print(module.twice(np.zeros(1)), sum(module.twice.stats.cache_hits.values()))
"""

# Ctrl-C (SIGINT) arrives while the kernel of the module is compiled. USE imports the module later.
INTERRUPTED = """
import os
import signal
from numba.core import event
import impact_damper.kernel.compiling

class Interrupt(event.Listener):
    sent = False

    def on_start(self, started):
        if not self.sent:
            self.sent = True
            os.kill(os.getpid(), signal.SIGINT)

    def on_end(self, ended):
        pass

# A shell that starts the tests in the background makes its processes ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)
event.register("numba:compile", Interrupt())
try:
    import module_of_kernels
except KeyboardInterrupt:
    print("interrupted")
"""


def run(folder, code):
    """Run a fresh Python that can import MODULE, with the cache of kernels in a folder."""
    (folder / "module_of_kernels.py").write_text(MODULE)
    paths = [str(folder), *sys.path]
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(paths),
        "NUMBA_CACHE_DIR": str(folder / "cache"),
    }
    process = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, timeout=120, env=environment
    )
    assert process.returncode == 0, process.stderr
    return process.stdout


def test_calls_by_address_do_the_same():
    direct, by = np.array([1.0, 2.0]), np.array([1.0, 2.0])
    for amount in (0.5, np.pi):
        pointed(add)(direct, np.full(2, amount))
        pointed(called)(by, np.full(2, amount))
    assert np.array_equal(direct, by) and direct[0] == 1.5 + np.pi


def test_an_interruption_of_compiling_raises_and_callers_are_cached(tmp_path):
    assert run(tmp_path, INTERRUPTED + USE) == "interrupted\n2.0 0\n"
    assert run(tmp_path, USE) == "2.0 1\n"
