"""Jobs that are handed over to a process which has imported what they need."""

import json
import socket
import subprocess
import sys
import time
from pathlib import Path

import pytest

from impact_damper.workflow import job_server

# What stands for a run: it starts the process, says where, and waits.
RUN = (
    "import json, sys; from impact_damper import warm; "
    "print(json.dumps(warm.start()), flush=True); sys.stdin.read()"
)
JOB = """
import os, sys, time
from types import SimpleNamespace
from impact_damper.workflow.job import begin
begin(SimpleNamespace(log=[__file__ + ".log"], input=NEEDED))
print("numba" in sys.modules, os.getcwd(), flush=True)
"""
LONG = "open(__file__ + '.pid', 'w').write(str(os.getpid())); time.sleep(60)"


@pytest.fixture(scope="module")
def through():
    """What hands over jobs to the process of a run, which afterwards is gone, with its folder."""
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen([sys.executable, "-c", RUN], text=True, **pipes) as run:
        words = json.loads(run.stdout.readline())
        address = Path(words[-1])
        wait_for(address.exists)
        yield words
        run.kill()
    wait_for(lambda: not address.parent.exists())


def wait_for(condition):
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.05)


def start(folder, code, through, needed=""):
    script = folder / "job.py"
    script.write_text(f"NEEDED = dict.fromkeys({needed.split()})" + JOB + code)
    return subprocess.Popen(
        [*through, sys.executable, script], cwd=folder, stderr=subprocess.PIPE, text=True
    )


@pytest.mark.parametrize(
    "code, expected",
    [("", 0), ("sys.exit(3)", 3), ("sys.exit(256)", 0), ("sys.exit('why')", 1), ("1 / 0", 1)],
)
def test_a_job_runs_where_the_modules_are(code, expected, through, tmp_path):
    assert start(tmp_path, code, through).wait() == expected
    told = (tmp_path / "job.py.log").read_text()
    assert told.startswith(f"True {tmp_path}\n")
    assert ("ZeroDivisionError" in told) == (code == "1 / 0")
    assert ("why" in told) == ("why" in code)


def test_what_concerns_a_file_reaches_the_terminal(through, tmp_path):
    _, told = start(tmp_path, "raise OSError('a.nc is broken')", through).communicate()
    assert told == "Error: a.nc is broken\n"


def test_a_job_without_such_a_process_runs_by_itself(through, tmp_path):
    assert start(tmp_path, "", [*through[:-1], tmp_path / "none"]).wait() == 0
    assert (tmp_path / "job.py.log").read_text() == f"False {tmp_path}\n"


def test_other_commands_are_run_as_they_are(through):
    command = [*through, "bash", "-c", 'echo "$1"; exit 3', "bash", "two words"]
    ended = subprocess.run(command, capture_output=True, text=True)
    assert (ended.returncode, ended.stdout) == (3, "two words\n")


def test_kernels_are_loaded_as_soon_as_a_job_needs_them(through, tmp_path):
    code = "from impact_damper import motion; print(len(motion.settle_many.signatures))"
    for needed, expected in [("", "0"), ("kernels", "1"), ("", "1")]:
        assert start(tmp_path, code, through, needed).wait() == 0
        assert (tmp_path / "job.py.log").read_text().split("\n")[1] == expected


def test_where_there_are_no_such_connections_nothing_is_handed_over(monkeypatch, tmp_path, capsys):
    long = tmp_path / ("long" * 30)
    long.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(long))
    assert job_server.start() == []
    assert "imports for itself" in capsys.readouterr().err
    assert not list(long.iterdir())


def test_a_job_ends_with_the_process_that_handed_it_over(through, tmp_path):
    job, pid = start(tmp_path, LONG, through), tmp_path / "job.py.pid"
    wait_for(lambda: pid.exists() and pid.read_text())
    assert int(pid.read_text()) != job.pid
    job.kill()
    job.wait()
    wait_for(lambda: not Path(f"/proc/{pid.read_text()}").exists())


def test_a_job_ends_with_the_run_that_waits_for_it(through, tmp_path):
    job = start(tmp_path, LONG, ["bash", "-c", '"$@" & wait', "bash", *through])
    pid = tmp_path / "job.py.pid"
    wait_for(lambda: pid.exists() and pid.read_text())
    job.kill()
    job.communicate()
    wait_for(lambda: not Path(f"/proc/{pid.read_text()}").exists())


def test_a_job_whose_child_is_killed_fails(through, tmp_path):
    job = start(tmp_path, "os.kill(os.getpid(), 9)", through)
    _, told = job.communicate()
    assert job.returncode == 1
    assert told == f"Error: the process that ran {tmp_path / 'job.py'} was killed.\n"


def test_a_connection_without_a_request_ends_nothing(through, tmp_path):
    with socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET) as connection:
        connection.connect(through[-1])
    assert start(tmp_path, "", through).wait() == 0
    assert (tmp_path / "job.py.log").read_text().startswith("True")
