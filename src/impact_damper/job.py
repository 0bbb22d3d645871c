"""What every job of the workflow begins with: its log, its tie to the run, and its last words."""

import os
import sys
import threading
import time
from contextlib import suppress

WATCH = 0.5  # seconds, less than another run takes to start a job


def begin(log) -> None:
    """Send what the job prints to its log, end it with its run, and tell files that stop it.

    A job outlives a Snakemake that is killed. It could then write what an older configuration
    gives over the results of a newer run, so it ends soon after the process that started it.

    An error that concerns a file says all in one line. It goes to the terminal too, for on a
    full disk nothing comes to the log.
    """
    terminal, show = sys.stderr, sys.excepthook

    def tell(kind, error, trace):
        if not issubclass(kind, OSError):
            return show(kind, error, trace)
        for place in (terminal, sys.stderr):
            with suppress(OSError):
                print(f"Error: {error}", file=place)

    sys.excepthook = tell
    sys.stdout = sys.stderr = open(log, "w", buffering=1)
    threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()


def _end_with(parent):
    while os.getppid() == parent:
        time.sleep(WATCH)
    os._exit(1)
