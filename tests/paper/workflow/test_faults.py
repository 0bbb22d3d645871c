"""Faults of a run that can be tried quickly. `make faults` tries all faults (tests/faults)."""

import os
import subprocess
import sys
import time

import pytest
from faults.project import DELETE, Project

from chatterjee1995.workflow.kernels import compiled_kernels

pytestmark = pytest.mark.workflow

FILE = "results/harmonic_balance/figure_05a.nc"
KERNELS = "results/kernels.compiled"
COMPILING = "Compiling the kernels again"

# Code of a job: the job opens its log, prints "begun" and runs an inserted statement.
JOB = (
    "import sys, time; from types import SimpleNamespace; from chatterjee1995.workflow.job "
    "import Job; "
    "Job(SimpleNamespace(log=[{!r}], output=['a.nc'], params=[])); print('begun'); {}"
)
LONG = "time.sleep(60); sys.__stdout__.write('lived on')"
# Code of a process in place of Snakemake: it starts a job, and waits.
RUN = "import subprocess, sys; subprocess.Popen([sys.executable, '-c', {!r}]); sys.stdin.read()"


def job_log(folder):
    """Return the path of a job's log in a folder of results, which is created."""
    log = folder / "logs/stage/job.log"
    log.parent.mkdir(parents=True)
    return log


@pytest.fixture(scope="module")
def first(tmp_path_factory):
    """Return a project with the result of one job after an edit of kernels, and its messages."""
    project = Project(tmp_path_factory.mktemp("faults") / "a project")
    marker = project.folder / KERNELS
    marker.parent.mkdir()
    marker.write_text("the digest of other sources")
    code, told = project.run(targets=[FILE])
    assert code == 0, told
    return project, told


def test_kernels_that_were_edited_are_compiled_before_the_first_job(first):
    project, told = first
    assert told.count(COMPILING) == 1
    assert told.index(COMPILING) < told.index("Harmonic balance of all curves")
    assert (project.folder / KERNELS).read_text() == compiled_kernels([])


def test_a_file_that_is_cut_off_is_told_and_made_again(first):
    finished, _ = first
    path = finished.folder / FILE
    whole, stat = path.read_bytes(), path.stat()
    path.write_bytes(whole[:-1])
    os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))
    code, told = finished.run(targets=[FILE])
    assert code == 1 and "Traceback" not in told
    assert f"{FILE} has {len(whole) - 1} bytes instead of {len(whole)}: {DELETE}." in told
    path.unlink()
    code, told = finished.run(targets=[FILE])
    assert code == 0 and COMPILING not in told, told
    assert path.read_bytes() == whole


def test_a_job_ends_with_its_run(tmp_path):
    log = job_log(tmp_path)
    command = [sys.executable, "-c", RUN.format(JOB.format(str(log), LONG))]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE}
    with subprocess.Popen(command, text=True, **pipes) as run:
        while not (log.exists() and log.read_text()):
            time.sleep(0.05)
        run.kill()
        # The job holds the other end of the pipe `run.stdout`. Reading blocks until the job ends.
        assert run.stdout.read() == ""


@pytest.mark.parametrize("kind", ["OSError", "ValueError"])
def test_what_stops_a_job_is_told(kind, tmp_path):
    """A file error is one line on terminal and log, any other error is a traceback in the log."""
    log = job_log(tmp_path)
    command = JOB.format(str(log), f"raise {kind}('a.nc is broken')")
    job = subprocess.run([sys.executable, "-c", command], capture_output=True, text=True)
    assert job.returncode == 1
    if kind == "OSError":
        assert job.stderr == "Error: a.nc is broken\n"
        assert log.read_text() == "begun\nError: a.nc is broken\n"
    else:
        assert job.stderr == ""
        assert "Traceback" in log.read_text() and "a.nc is broken" in log.read_text()


@pytest.mark.parametrize("megabytes", [0, 300])
def test_the_timing_of_a_job_is_its_own(megabytes, tmp_path):
    """The timing holds the memory of the job, and not of the process that starts the job."""
    kept = bytearray(b"1") * (200 * 2**20)
    work = f"kept = bytearray(b'1') * ({megabytes} * 2**20); time.sleep(0.5)"
    code = JOB.format(str(job_log(tmp_path)), work)
    subprocess.run([sys.executable, "-c", code], check=True)
    assert len(kept) == 200 * 2**20
    header, values = (tmp_path / "timings/stage/job.tsv").read_text().splitlines()
    timing = dict(zip(header.split(), map(float, values.split()), strict=True))
    assert 0.5 < timing["seconds"] < 30
    assert 0 < timing["cpu_seconds"] < 10
    assert megabytes < timing["peak_memory_mb"] < megabytes + 100
