"""Damaged and foreign files in the folder of results, and two runs at once.

A run must stop and name a damaged file. After the file is deleted, a run must recover.
"""

import os
import time
from functools import partial

from .project import DATA, DELETE, LOCKED, expect

# A dataset of another job than DATA.
OTHER = "results/harmonic_balance/figure_05a.nc"


def _cut(path, random):
    os.truncate(path, int(random.integers(1, path.stat().st_size)))


def _zeroed(path, random):
    content = path.read_bytes()
    kept = int(random.integers(len(content) // 2, len(content) - 8000))
    path.write_bytes(content[:kept] + bytes(len(content) - kept))


DAMAGES = {
    "cut off": _cut,
    "empty": lambda path, random: path.write_bytes(b""),
    "its end made zero": _zeroed,
    "a text in its place": lambda path, random: path.write_text("time,displacement\n0,1\n"),
    "the result of another job in its place": lambda path, random: path.write_bytes(
        (path.parents[2] / OTHER).read_bytes()
    ),
}


def damaged(context):
    """Yield a trial of each damage of DATA."""
    for name in DAMAGES:
        yield f"a NetCDF file in `results/`: {name}", partial(_damaged, context, name)


def _damaged(context, name):
    project = context.finished(name.replace(" ", "-"))
    path = project.folder / DATA
    DAMAGES[name](path, context.random(name))
    code, told = project.run()
    expect(code, "the run does not stop at the damaged file")
    lines = [line for line in told.splitlines() if DATA in line and DELETE in line]
    expect(lines, f"no message says what to do: {told[-500:]}")
    expect("Traceback" not in told, "a traceback is shown")
    path.unlink()
    # Two jobs may run again: the job that makes the file, and the job of the chapter that reads it.
    project.recover(context.undisturbed, lost=2)
    return "delete the file, as the message says; run again"


def two_runs(context):
    """Yield a trial with two runs at once in one folder."""

    def trial():
        project = context.fresh("two-runs")
        both = [project.start()]
        time.sleep(0.25 * context.seconds)
        both.append(project.start())
        told = [process.communicate()[0] for process in both]
        codes = [process.returncode for process in both]
        expect(codes[0] == 0, f"the first run is disturbed: {told[0][-500:]}")
        expect(codes[1] and LOCKED in told[1], f"the second is not refused: {told[1][-500:]}")
        project.expect_same(context.undisturbed)
        return "nothing: the first run finishes, the second is refused"

    yield "two runs at once", trial


TRIALS = [damaged, two_runs]
