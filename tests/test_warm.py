"""Jobs that are handed over to a process which has imported what they need."""

import os
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from impact_damper import warm

# What stands for a run: it starts the process, says where, and waits.
RUN = (
    "import os, sys; from impact_damper import warm; warm.start(); "
    "print(os.environ[warm.ADDRESS], flush=True); sys.stdin.read()"
)
JOB = """
import os, sys, time
from types import SimpleNamespace
from impact_damper.job import begin
begin(SimpleNamespace(log=[__file__ + ".log"], input={}))
print("numba" in sys.modules, os.getcwd(), flush=True)
"""
LONG = "open(__file__ + '.pid', 'w').write(str(os.getpid())); time.sleep(60)"


@pytest.fixture(scope="module")
def address():
    """Where the process of a run waits for jobs; afterwards it is gone, with its folder."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", RUN], text=True, **pipes) as run:
        found = Path(run.stdout.readline().strip())
        wait_for(found.exists)
        yield found
        run.kill()
    wait_for(lambda: not found.parent.exists())


def wait_for(condition):
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def start(folder, code, address):
    script = folder / "job.py"
    script.write_text(JOB + code)
    return subprocess.Popen(
        [sys.executable, script],
        cwd=folder,
        env=os.environ | {warm.ADDRESS: str(address)},
        stderr=subprocess.PIPE,
        text=True,
    )


@pytest.mark.parametrize(
    "code, expected", [("", 0), ("sys.exit(3)", 3), ("sys.exit('why')", 1), ("1 / 0", 1)]
)
def test_a_job_runs_where_the_modules_are(code, expected, address, tmp_path):
    assert start(tmp_path, code, address).wait() == expected
    told = (tmp_path / "job.py.log").read_text()
    assert told.startswith(f"True {tmp_path}\n")
    assert ("ZeroDivisionError" in told) == (code == "1 / 0")
    assert ("why" in told) == ("why" in code)


def test_what_concerns_a_file_reaches_the_terminal(address, tmp_path):
    _, told = start(tmp_path, "raise OSError('a.nc is broken')", address).communicate()
    assert told == "Error: a.nc is broken\n"


def test_a_job_without_such_a_process_runs_by_itself(tmp_path):
    assert start(tmp_path, "", tmp_path / "none").wait() == 0
    assert (tmp_path / "job.py.log").read_text() == f"False {tmp_path}\n"


def test_a_job_ends_with_the_process_that_handed_it_over(address, tmp_path):
    job, pid = start(tmp_path, LONG, address), tmp_path / "job.py.pid"
    wait_for(lambda: pid.exists() and pid.read_text())
    assert int(pid.read_text()) != job.pid
    job.kill()
    job.wait()
    wait_for(lambda: not Path(f"/proc/{pid.read_text()}").exists())


def test_a_job_whose_child_is_killed_fails(address, tmp_path):
    job = start(tmp_path, "os.kill(os.getpid(), 9)", address)
    _, told = job.communicate()
    assert job.returncode == 1
    assert told == f"Error: the process that ran {tmp_path / 'job.py'} was killed.\n"


def test_a_connection_without_a_request_ends_nothing(address, tmp_path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as connection:
        connection.connect(str(address))
    assert start(tmp_path, "", address).wait() == 0
    assert (tmp_path / "job.py.log").read_text().startswith("True")
