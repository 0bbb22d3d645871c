"""Damaged and foreign files in the folder of results.

The run must stop and name the damaged file; after its deletion a run must recover.
"""

import os

import xarray as xr

from .project import DATA, DELETE, expect

# A dataset of another job than DATA.
OTHER = "results/harmonic_balance/figure_05a.nc"


def _cut(path, random):
    os.truncate(path, int(random.integers(1, path.stat().st_size)))


def _emptied(path, random):
    path.write_bytes(b"")


def _zeroed(path, random):
    content = path.read_bytes()
    kept = int(random.integers(len(content) // 2, len(content) - 8000))
    path.write_bytes(content[:kept] + bytes(len(content) - kept))


def _text(path, random):
    path.write_text("time,displacement\n0,1\n")


def _other_netcdf(path, random):
    xr.Dataset({"temperature": ("time", [1.0, 2.0])}).to_netcdf(path, engine="netcdf4")


def _other_result(path, random):
    path.write_bytes((path.parents[2] / OTHER).read_bytes())


DAMAGES = {
    "cut off": _cut,
    "empty": _emptied,
    "its end made zero": _zeroed,
    "a text in its place": _text,
    "a NetCDF file of another program in its place": _other_netcdf,
    "the result of another job in its place": _other_result,
}


def damaged(context):
    """Yield a trial of each damage of DATA, and of two damages that do not change its date."""
    for name, damage in DAMAGES.items():
        yield f"a NetCDF file in `results/`: {name}", _trial(context, name, damage, False)
    for name in ("cut off", "empty"):
        yield (
            f"a NetCDF file in `results/`: {name}, with its old date",
            _trial(context, f"old {name}", DAMAGES[name], True),
        )


def _trial(context, name, damage, old):
    """Return a trial of a damage; if `old`, the damaged file keeps the date it had before."""

    def trial():
        project = context.finished(name.replace(" ", "-"))
        path = project.folder / DATA
        stat = path.stat()
        damage(path, context.random(name))
        if old:
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

    return trial


TRIALS = [damaged]
