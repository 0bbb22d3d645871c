"""A process that has imported what jobs need, and runs them in children of its own.

To import numpy, xarray and numba and to load the compiled kernels takes a job longer than most of
them compute. `start` lets one process do so for a whole run, beside the first jobs; it ends with
the run. The process that Snakemake starts for a job hands its script over, waits for the end and
ends likewise (`hand_over`); if it is killed, so is the child. Where there is no such process, as
on the nodes of a cluster, a job does all of it itself.
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

ADDRESS = "IMPACT_DAMPER_WARM"
# Between them they import what all jobs do. By name: what a module imports itself counts for the
# workflow as what its jobs depend on.
MODULES = [
    "impact_damper.warmup",
    "impact_damper.accuracy",
    "impact_damper.migration",
    "impact_damper.tables",
    "netCDF4",
    "snakemake.script",
]
# As Snakemake sets them for a job of one thread.
THREADS = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"]
# Seconds between two looks whether the run goes on, less than another takes to start a job.
LOOK = 0.5
LONGEST_SILENCE = 5.0  # seconds
LONGEST_REQUEST = 2**16
# Objects made before a garbage collection, and collections of a generation before one of the next:
# more than by default. What is there when a child begins is passed over.
GARBAGE_LIMITS = 50_000, 20, 50
REFUSED = 255


def start() -> None:
    """Start the process, and tell the jobs of it by the environment variable ADDRESS.

    It can be reached once it is ready; the first jobs do not wait for it.
    """
    folder = tempfile.mkdtemp(prefix="impact-damper-")
    subprocess.Popen(
        [sys.executable, "-m", "impact_damper.warm", folder, str(os.getpid())],
        env=os.environ | dict.fromkeys(THREADS, "1"),
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.environ[ADDRESS] = f"{folder}/jobs"


def hand_over(compiled) -> None:
    """Let the script of this process run in a child of the warm one; return if there is none.

    Parameters
    ----------
    compiled : bool
        Whether the kernels are compiled, so that they can be loaded.
    """
    address = os.environ.get(ADDRESS)
    if address is None:
        return
    request = {
        "script": os.path.abspath(sys.argv[0]),
        "folder": os.getcwd(),
        "python": sys.prefix,
        "compiled": compiled,
    }
    try:
        with _socket() as connection:
            connection.connect(address)
            socket.send_fds(connection, [json.dumps(request).encode()], [1, 2])
            answer = connection.recv(1)
    except OSError:
        return
    if not answer:
        print(f"Error: the process that ran {request['script']} was killed.", file=sys.stderr)
        sys.stderr.flush()
        os._exit(1)
    if answer[0] != REFUSED:
        os._exit(answer[0])


def serve(folder, run) -> None:
    """Run jobs until the run, the process that started this one, is gone."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    for module in MODULES:
        import_module(module)
    import_module("impact_damper.figures.style").draw_first()
    gc.set_threshold(*GARBAGE_LIMITS)
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    listener = _socket()
    listener.settimeout(LOOK)
    listener.bind(f"{folder}/jobs")
    listener.listen(4096)
    loaded = False
    while os.getppid() == run:
        # A job that is killed before it has said what it wants closes the connection.
        with suppress(OSError, json.JSONDecodeError):
            connection, _ = listener.accept()
            connection.settimeout(LONGEST_SILENCE)
            request, files, _, _ = socket.recv_fds(connection, LONGEST_REQUEST, 2)
            connection.settimeout(None)
            request = json.loads(request)
            if request["compiled"] and not loaded:
                _load_kernels()
                loaded = True
            gc.freeze()
            if os.fork() == 0:
                try:
                    _run(connection, request, files)
                finally:
                    os._exit(1)
            connection.close()
            for file in files:
                os.close(file)
    shutil.rmtree(folder, ignore_errors=True)


def _load_kernels():
    # An error is left to the jobs, which tell it.
    with suppress(Exception):
        import_module("impact_damper.warmup").warm_up()


def _run(connection, request, files):
    """The life of a child: one script."""
    for signal_number in (signal.SIGINT, signal.SIGCHLD):
        signal.signal(signal_number, signal.SIG_DFL)
    for file, place in zip(files, (1, 2), strict=True):
        os.dup2(file, place)
    threading.Thread(target=_end_with, args=(connection,), daemon=True).start()
    code = REFUSED
    if request["python"] == sys.prefix:
        os.chdir(request["folder"])
        sys.argv[:] = [request["script"]]
        code = _code_of(request["script"])
    with suppress(OSError):
        sys.stdout.flush()
        connection.send(bytes([code]))


def _code_of(script):
    """Exit code of a script that is run here."""
    try:
        runpy.run_path(script, run_name="__main__")
    except SystemExit as end:
        if isinstance(end.code, str):
            print(end.code, file=sys.stderr)
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        sys.excepthook(*sys.exc_info())
        return 1
    return 0


def _end_with(connection):
    connection.recv(1)
    os._exit(1)


def _socket():
    return socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)


if __name__ == "__main__":
    serve(sys.argv[1], int(sys.argv[2]))
