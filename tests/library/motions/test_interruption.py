"""Ctrl-C in a long call from Python raises KeyboardInterrupt within two seconds."""

import subprocess
import sys

import pytest

pytestmark = pytest.mark.thorough

# Before each long call a short call compiles the kernels.
SCRIPT = """
import os
import signal
import threading
import time
import impact_damper as idm

# A shell that starts the tests in the background makes its processes ignore Ctrl-C.
signal.signal(signal.SIGINT, signal.default_int_handler)
oscillator, damper = idm.Oscillator(0.215), idm.Damper(0.12, 2.0)
large = (1.8787, -2.4769, 0.0245, -0.4529)
free, slow = idm.Oscillator(1e-3), idm.Settling(patience=10**7, limit=10**8, tolerance=1e-14)
instants = []

def interrupt():
    instants.append(time.process_time())
    os.kill(os.getpid(), signal.SIGINT)

for name, (short, long) in CALLS.items():
    eval(short)
    instants.clear()
    threading.Timer(0.3, interrupt).start()
    try:
        while True:
            eval(long)
    except KeyboardInterrupt:
        assert time.process_time() - instants[0] < 2.0, name
        print(name, flush=True)
"""

CALLS = {
    "simulate": "idm.simulate(oscillator, damper, 1.7, large, periods={}, samples=2)",
    "steady_motion": "idm.steady_motion(free, idm.Damper(0.12, 2.0), 1.7, large, settling={})",
    "frequency_response": "idm.frequency_response(oscillator, damper, {})",
    "basins": "idm.basins(oscillator, None, 1.85, cells={})",
    "migrate": "idm.migrate(oscillator, damper, 2.0, periods={})",
}
ARGUMENTS = {
    "simulate": ("1", "1e6"),
    "steady_motion": ("None", "slow"),
    "frequency_response": ("[2.0]", "[1.6 + k / 1000 for k in range(400)]"),
    "basins": ("2", "3000"),
    "migrate": ("10", "10**6"),
}


@pytest.fixture(scope="module")
def interrupted():
    """Interrupt all calls in turn. Return the process, which printed the names of the calls."""
    calls = {name: [call.format(each) for each in ARGUMENTS[name]] for name, call in CALLS.items()}
    code = f"CALLS = {calls!r}\n{SCRIPT}"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=200)


@pytest.mark.parametrize("name", CALLS)
def test_an_interruption_is_heard_within_two_seconds(name, interrupted):
    assert name in interrupted.stdout.split(), interrupted.stderr
