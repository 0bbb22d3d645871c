"""Damaged and foreign files in the folder of results, two runs at once, and a clock set back.

A run must stop and name a damaged file; after its deletion a run must recover. A trial cannot set
the computer's clock, so it dates files to tomorrow, as they seem after a clock was set back.
"""

import os
import time
from functools import partial

import xarray as xr

from .project import DATA, DELETE, LOCKED, expect

# A dataset of another job than DATA.
OTHER = "results/harmonic_balance/figure_05a.nc"
DAY = 86400


def _cut(path, random):
    os.truncate(path, int(random.integers(1, path.stat().st_size)))


def _zeroed(path, random):
    content = path.read_bytes()
    kept = int(random.integers(len(content) // 2, len(content) - 8000))
    path.write_bytes(content[:kept] + bytes(len(content) - kept))


def _other_netcdf(path, random):
    xr.Dataset({"temperature": ("time", [1.0, 2.0])}).to_netcdf(path, engine="netcdf4")


DAMAGES = {
    "cut off": _cut,
    "empty": lambda path, random: path.write_bytes(b""),
    "its end made zero": _zeroed,
    "a text in its place": lambda path, random: path.write_text("time,displacement\n0,1\n"),
    "a NetCDF file of another program in its place": _other_netcdf,
    "the result of another job in its place": lambda path, random: path.write_bytes(
        (path.parents[2] / OTHER).read_bytes()
    ),
}


def damaged(context):
    """Yield a trial of each damage of DATA, and of two damages that keep its date."""
    for name in DAMAGES:
        yield f"a NetCDF file in `results/`: {name}", partial(_damaged, context, name)
    for name in ("cut off", "empty"):
        told = f"a NetCDF file in `results/`: {name}, with its old date"
        yield told, partial(_damaged, context, name, dated=True)


def _damaged(context, name, dated=False):
    project = context.finished(name.replace(" ", "-"))
    path = project.folder / DATA
    stat = path.stat()
    DAMAGES[name](path, context.random(name))
    if dated:
        os.utime(path, ns=(stat.st_atime_ns, stat.st_mtime_ns))
    code, told = project.run()
    expect(code, "the run does not stop at the damaged file")
    lines = [line for line in told.splitlines() if DATA in line and DELETE in line]
    expect(lines, f"no message says what to do: {told[-500:]}")
    expect("Traceback" not in told, "a traceback is shown")
    path.unlink()
    # Two jobs may run again: the job of the file, and the job of the chapter made from it.
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


def clock_set_back(context):
    """Yield trials in which results seem to be from tomorrow."""

    def tomorrow(name):
        project = context.finished(name)
        for path in (project.folder / "results").rglob("*"):
            if path.is_file():
                os.utime(path, (time.time() + DAY,) * 2)
        return project

    def halfway():
        project = tomorrow("clock-halfway")
        for path in (project.folder / "results").rglob("*"):
            if path.suffix in (".csv", ".md", ".png", ".pdf", ".rst"):
                path.unlink()
        return project.recover(context.undisturbed, lost=0)

    def edited():
        project = tomorrow("clock-edited")
        project.edit("workflow/scripts/stage.py", "Job(", "# A word.\nJob(")
        before = project.written()[DATA]
        code, told = project.run()
        expect(code == 0, told[-500:])
        expect(project.written()[DATA] != before, "the job of the edited script did not run")
        project.expect_same(context.undisturbed)
        return "run again"

    yield "clock set back between data and figures", halfway
    yield "clock set back, then a script edited", edited


TRIALS = [damaged, two_runs, clock_set_back]
