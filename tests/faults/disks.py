"""A full disk, and a folder that cannot be written to; all trials need the right to mount."""

import subprocess
from contextlib import contextmanager
from functools import partial

from .project import DATA, expect

FULL = "No space left on device"
# Sizes of two disks, both too small for the results. The run fails early or late.
KILOBYTES = (8, 120)


class CannotMount(Exception):
    """A file system cannot be mounted, so the trial is skipped."""


def _mount(*arguments):
    try:
        done = subprocess.run(["mount", *map(str, arguments)], capture_output=True, text=True)
    except FileNotFoundError as error:
        raise CannotMount("there is no `mount` here") from error
    if done.returncode:
        raise CannotMount(done.stderr.strip())


@contextmanager
def _mounted(folder, *arguments):
    folder.mkdir(parents=True, exist_ok=True)
    _mount(*arguments, folder)
    try:
        yield
    finally:
        subprocess.run(["umount", "--lazy", str(folder)], check=True)


def full_disk(context):
    """Yield trials on disks of several sizes, which become full during the run."""
    for kilobytes in KILOBYTES:
        yield f"a full disk under `results/`, of {kilobytes} kB", partial(_full, context, kilobytes)


def _full(context, kilobytes):
    project = context.fresh(f"full-{kilobytes}")
    disk = project.folder / "results"
    with _mounted(disk, "-t", "tmpfs", "-o", f"size={kilobytes}k", "tmpfs"):
        code, told = project.run()
        expect(code, "the run ends without an error")
        expect(FULL in told, f"no message says that the disk is full: {told[-500:]}")
        project.expect_only_whole(context.undisturbed)
        _mount("-o", "remount,size=1g", disk)
        return f"make room on the disk, {project.recover(context.undisturbed)}"


def read_only(context):
    """Yield a trial in which nothing can be written into `results/`, and data are missing."""

    def trial():
        project = context.finished("read-only")
        (project.folder / DATA).unlink()
        results = project.folder / "results"
        with _mounted(results, "--bind", results):
            _mount("-o", "remount,ro,bind", results)
            code, told = project.run()
        expect(code, "the run ends without an error")
        expect("make it writable" in told, f"no message says what to do: {told[-500:]}")
        expect("Traceback" not in told, "a traceback is shown")
        project.recover(context.undisturbed)
        return "make the folder writable, as the message says; run again"

    yield "a read-only `results/`", trial


TRIALS = [full_disk, read_only]
