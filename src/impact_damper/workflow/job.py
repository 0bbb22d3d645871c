"""What every job of the workflow begins with: its log, its tie to the run, and its last words."""

import os
import sys
import threading
import time
from contextlib import suppress

from impact_damper.workflow.job_client import LOOK

# Whether this process is to have the kernels loaded and has not yet (`warm`).
kernels_missing = False


class KernelsMissing(BaseException):
    """Ends a job that needs the kernels where they are missing; it begins again with them."""


def begin(job) -> None:
    """Send what the job prints to its log, end it with its run, and tell files that stop it.

    A job outlives a Snakemake that is killed. It could then write what an older configuration
    gives over the results of a newer run, so it ends soon after the process that started it.

    An error that concerns a file says all in one line. It goes to the terminal too, for on a
    full disk nothing comes to the log.

    Parameters
    ----------
    job : object
        With the attributes `log` and `input` of Snakemake's scripts.
    """
    terminal, show = sys.stderr, sys.excepthook

    def tell(kind, error, trace):
        if not issubclass(kind, OSError):
            return show(kind, error, trace)
        for place in (terminal, sys.stderr):
            with suppress(OSError):
                print(f"Error: {error}", file=place)

    end_with_parent()
    if kernels_missing and "kernels" in job.input.keys():
        raise KernelsMissing
    sys.excepthook = tell
    sys.stdout = sys.stderr = open(job.log[0], "w", buffering=1)


def end_with_parent() -> None:
    """End this process soon after the one that started it."""
    threading.Thread(target=_end_with, args=(os.getppid(),), daemon=True).start()


def _end_with(parent):
    while os.getppid() == parent:
        time.sleep(LOOK)
    os._exit(1)
