"""Kernels called by address do what they do when called, and a failure is not passed over."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from helpers.pointed import pointed

from impact_damper.kernel.by_address import by_address
from impact_damper.kernel.compiling import kernel


@kernel
def add(a, d):
    """a += d, of two numbers."""
    for i in range(2):
        a[i] += d[i]


@kernel
def take_away(a, d):
    """a -= d, of two numbers."""
    for i in range(2):
        a[i] -= d[i]


called = by_address(add)

INTERRUPTED = """
import os
import signal
import threading
import numba
import numpy as np
from impact_damper.kernel.compiling import kernel, pointer
from impact_damper.kernel.by_address import by_address

@kernel
def add(a):
    a[0] += 1.0

called = by_address(add)

@numba.njit(nogil=True)
def caller(a, count):
    x = 0.0
    for k in range(count):
        x += np.sin(k)
    called(pointer(a))
    called(pointer(a))
    return x

caller(np.zeros(1), 0) if COMPILED else caller.compile("(float64[::1], int64)")
threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
a = np.zeros(1)
try:
    caller(a, 10**8)
except KeyboardInterrupt:
    pass
print("counted", a[0])
"""

FAILING = """
import numba
import numpy as np
from impact_damper.kernel.compiling import kernel, pointer
from impact_damper.kernel.by_address import by_address

@kernel
def wrong(a):
    a[0] = "a text"

called = by_address(wrong)

@numba.njit
def caller(a):
    called(pointer(a))
    return a[0]

print("went on with", caller(np.zeros(1)))
"""


def test_calls_by_address_do_the_same():
    direct, by = np.array([1.0, 2.0]), np.array([1.0, 2.0])
    for amount in (0.5, np.pi):
        pointed(add)(direct, np.full(2, amount))
        pointed(called)(by, np.full(2, amount))
    assert np.array_equal(direct, by) and direct[0] == 1.5 + np.pi


def test_threads_may_call_first_at_once():
    call = pointed(by_address(take_away))
    arrays = np.zeros((16, 2))
    with ThreadPoolExecutor(4) as pool:
        list(pool.map(lambda each: call(each, np.ones(2)), arrays))
    assert np.all(arrays == -1.0)


@pytest.mark.parametrize("compiled", [True, False])
def test_an_interruption_skips_no_call(compiled, tmp_path):
    """It comes while compiled code runs, and is seen when that enters Python to find an address."""
    script = tmp_path / "interrupted.py"
    script.write_text(INTERRUPTED.replace("COMPILED", str(compiled)))
    run = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120)
    assert run.stdout == "counted 2.0\n" or run.returncode == 1, run.stderr


def test_a_name_has_one_address():
    with pytest.raises(ValueError, match="test_by_address.add: has an address"):
        by_address(add)


def test_an_error_in_compiling_ends_the_process(tmp_path):
    script = tmp_path / "failing.py"
    script.write_text(FAILING)
    run = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=120)
    assert run.returncode == 1
    assert "went on" not in run.stdout
    assert "native_lowering" in run.stderr
