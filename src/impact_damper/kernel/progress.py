"""Print a line on standard error if the compilation of kernels takes long."""

import gc
import sys
import time

from numba.core import event

PATIENCE = 1.0  # seconds
MESSAGE = "impact_damper: compiling kernels; later sessions will load them from the cache"


class Progress(event.Listener):
    """Adds up the time spent on compiling functions of this package, and prints MESSAGE once.

    MESSAGE is printed when the sum exceeds PATIENCE. The garbage collector is switched off during
    compilation, because it finds little garbage and would take a fifth of the time.
    """

    def __init__(self):
        self.depth = 0
        self.spent = 0.0
        self.written = False

    def on_start(self, started):
        if not _is_own(started):
            return
        if self.depth == 0:
            self.begun = time.perf_counter()
            self.collecting = gc.isenabled()
            gc.disable()
        self.depth += 1
        self._write()

    def on_end(self, ended):
        if not _is_own(ended):
            return
        self.depth -= 1
        self._write()
        if self.depth == 0:
            self.spent += time.perf_counter() - self.begun
            if self.collecting:
                gc.enable()

    def _write(self):
        spent = self.spent + time.perf_counter() - self.begun
        if spent > PATIENCE and not self.written:
            self.written = True
            print(MESSAGE, file=sys.stderr, flush=True)


def _is_own(compiled):
    """Return whether an event concerns a function of this package or of a module it generated."""
    return compiled.data["dispatcher"].py_func.__module__.startswith("impact_damper")


def show_progress():
    """Register a `Progress` with numba, so that slow compilations print MESSAGE."""
    event.register("numba:compile", Progress())
