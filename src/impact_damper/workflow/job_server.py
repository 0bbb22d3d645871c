"""A process that has imported what jobs need, and runs them in children of its own.

To import numpy, xarray and numba and to load the compiled kernels takes a job longer than most of
them compute. `start` lets one process do so for a whole run, beside the first jobs; it ends with
the run. What Snakemake starts for a job hands its script over, waits for the end and ends likewise
(`hand_over`); if it is killed, so is the child. Where there is no such process, as on the nodes of
a cluster and on macOS, a job does all of it itself.
"""

import gc
import json
import os
import runpy
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
from contextlib import suppress
from importlib import import_module

from impact_damper.workflow import job, job_client
from impact_damper.workflow.job_client import AGAIN, LOOK, new_socket

# Between them they import what all jobs do. By name: the run that starts the process does without.
MODULES = [
    "impact_damper.workflow.compile_kernels",
    "impact_damper.stages.accuracy",
    "impact_damper.stages.migration",
    "impact_damper.tables.responses",
    "netCDF4",
    "snakemake.script",
]
# As Snakemake sets them for a job of one thread.
THREADS = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"]
LONGEST_SILENCE = 5.0  # seconds
LONGEST_REQUEST = 2**16
# Objects made before a garbage collection, and collections of a generation before one of the next:
# more than by default. What is there when a child begins is passed over.
GARBAGE_LIMITS = 50_000, 20, 50


def start() -> list[str]:
    """Start the process; returns what stands before the command of a job to hand it over.

    Nothing does where this system knows no such connections, or not at so long a path, which is
    told. The process can be reached once it is ready; the first jobs do not wait for it.
    """
    folder = tempfile.mkdtemp(prefix="impact-damper-")
    address = f"{folder}/jobs"
    try:
        with new_socket() as trial:
            trial.bind(f"{address}-")
    except OSError as error:
        shutil.rmtree(folder)
        print(f"Each job imports for itself, which takes longer: {error}.", file=sys.stderr)
        return []
    subprocess.Popen(
        [sys.executable, "-m", "impact_damper.workflow.job_server", address, str(os.getpid())],
        env=os.environ | dict.fromkeys(THREADS, "1"),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    return [sys.executable, "-IS", job_client.__file__, address]


def serve(address, run) -> None:
    """Run jobs until the run, the process that started this one, is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for module in MODULES:
        import_module(module)
    import_module("impact_damper.figures.style").draw_first()
    gc.set_threshold(*GARBAGE_LIMITS)
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    job.kernels_missing = True
    listener = new_socket()
    listener.settimeout(LOOK)
    listener.bind(address)
    listener.listen(4096)
    while os.getppid() == run:
        # A job that is killed before it has said what it wants closes the connection. One for
        # which there can be no child is told so by the end of the connection.
        with suppress(OSError, json.JSONDecodeError):
            connection, _ = listener.accept()
            with connection:
                _start_child(connection)
    shutil.rmtree(os.path.dirname(address), ignore_errors=True)


def _start_child(connection):
    """Have a child run what the other end asks for."""
    connection.settimeout(LONGEST_SILENCE)
    request, files, _, _ = socket.recv_fds(connection, LONGEST_REQUEST, 2)
    connection.settimeout(None)
    try:
        request = json.loads(request)
        if request["kernels"] and job.kernels_missing:
            _load_kernels()
            job.kernels_missing = False
        gc.freeze()
        if os.fork() == 0:
            try:
                _run(connection, request, files)
            finally:
                os._exit(1)
    finally:
        for file in files:
            os.close(file)


def _load_kernels():
    # An error is left to the jobs, which tell it.
    with suppress(Exception):
        import_module("impact_damper.workflow.compile_kernels").warm_up()


def _run(connection, request, files):
    """The life of a child: one script."""
    for signal_number in (signal.SIGINT, signal.SIGCHLD):
        signal.signal(signal_number, signal.SIG_DFL)
    for file, place in zip(files, (1, 2), strict=True):
        os.dup2(file, place)
    threading.Thread(target=_end_with, args=(connection,), daemon=True).start()
    os.chdir(request["folder"])
    sys.argv[:] = [request["script"]]
    code = _code_of(request["script"])
    with suppress(OSError):
        sys.stdout.flush()
        connection.send(code.to_bytes(2, "big"))


def _code_of(script):
    """Exit code of a script that is run here, or AGAIN."""
    try:
        runpy.run_path(script, run_name="__main__")
    except job.KernelsMissing:
        return AGAIN
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
        return end.code & 255 if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        sys.excepthook(*sys.exc_info())
        return 1
    return 0


def _end_with(connection):
    connection.recv(1)
    os._exit(1)


if __name__ == "__main__":
    serve(sys.argv[1], int(sys.argv[2]))
