"""Run all trials or chosen kinds of trials, and print the outcome of each trial."""

import argparse
import shutil
import signal
import sys
import tempfile
import time
import zlib
from pathlib import Path

import numpy as np

from . import disks, files, kills
from .disks import CannotMount
from .project import Fault, Project, end_all, expect

# Kind of trials -> generator of (name, trial). A trial is a function that returns what the user has
# to do after the fault, or raises `Fault`.
KINDS = {trials.__name__: trials for part in (kills, files, disks) for trials in part.TRIALS}


class Context:
    """What all trials share: a folder, the outputs of an undisturbed run, and random generators."""

    def __init__(self, folder, given):
        self.folder, self.seed, self.moments = folder, given.seed, given.moments
        self._whole = Project(folder / "undisturbed")
        code, told = self._whole.run()  # the first run also compiles the kernels (numba)
        expect(code == 0, told)
        self.undisturbed = self._whole.outputs()
        begin = time.monotonic()
        again = self.fresh("timed")
        expect(again.run()[0] == 0, "the undisturbed run fails")
        self.seconds = time.monotonic() - begin
        again.expect_same(self.undisturbed)

    def fresh(self, name):
        """Return a copy of the project without results."""
        return Project(self.folder / name)

    def finished(self, name):
        """Return a copy of the project with the results of an undisturbed run."""
        return Project(self.folder / name, like=self._whole)

    def clear(self):
        """Remove all copies except the undisturbed run."""
        for left in self.folder.iterdir():
            if left != self._whole.folder:
                shutil.rmtree(left, ignore_errors=True)

    def random(self, name):
        """Return the random generator of a trial, which depends on the seed and the name only."""
        return np.random.default_rng([self.seed, zlib.crc32(name.encode())])


def tried(trial):
    """Run a trial; return its outcome, and what the user has to do or why the trial failed."""
    try:
        return "as it should", trial()
    except CannotMount as reason:
        return "skipped", str(reason)
    except Fault as fault:
        return "FAILED", " ".join(str(fault).split())


def main():
    reader = argparse.ArgumentParser(prog="python -m faults", description=__doc__)
    reader.add_argument("kinds", nargs="*", help=f"{', '.join(KINDS)}; all if none is given")
    reader.add_argument("--moments", type=int, default=20, help="number of kills of each kind")
    reader.add_argument("--seed", type=int, default=1995, help="seed of random moments and damages")
    given = reader.parse_args()
    # Raise SystemExit on SIGTERM, so that unfinished runs are ended and disks unmounted.
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(1))
    outcomes = set()
    with tempfile.TemporaryDirectory(prefix="faults-") as folder:
        try:
            context = Context(Path(folder), given)
            for kind in given.kinds or KINDS:
                for name, trial in KINDS[kind](context):
                    outcome, told = tried(trial)
                    outcomes.add(outcome)
                    print(f"{outcome:12s} | {name} | {told}", flush=True)
                    context.clear()
        finally:
            end_all()
    sys.exit("FAILED" in outcomes)


main()
