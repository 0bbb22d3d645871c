"""Files that appear only when they are complete, and a quick check for truncated NetCDF files."""

import glob
import os
from contextlib import contextmanager, suppress
from pathlib import Path

DELETE = "delete it and run the same command again"  # the workflow's advice about a broken file

# An HDF5 file begins with SIGNATURE and a superblock. If the superblock begins with one of
# VERSIONS, the slice LENGTH of the file's bytes holds the length of the file.
SIGNATURE = b"\x89HDF\r\n\x1a\n"
VERSIONS = (b"\x02\x08\x08", b"\x03\x08\x08")
LENGTH = slice(28, 36)


class BrokenFileError(OSError):
    """A file is damaged, or was not written by this project. The message names the file."""


@contextmanager
def whole(path):
    """Yield a temporary path. On success, the file written there is renamed to `path`."""
    path = Path(path)
    part = path.with_name(f"{path.name}.part-{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        for left in path.parent.glob(f"{glob.escape(path.name)}.part-*"):  # by killed processes
            left.unlink(missing_ok=True)
        yield part
        os.replace(part, path)
    except BrokenFileError:
        raise  # the caller read another file, and that file is broken
    except OSError as error:
        raise OSError(f"{path} cannot be written: {_reason(path.parent, error)}") from error
    finally:
        with suppress(OSError):
            part.unlink()


def check_writable(path):
    """Return `path`, which may be None. Raise OSError if no file can be written there."""
    if path is not None:
        probe = path.with_name(f"{path.name}.check")
        with whole(probe) as part:
            part.touch()
        probe.unlink()
    return path


def _reason(folder, error):
    trial = folder / f".trial-{os.getpid()}"
    try:
        with trial.open("wb") as file:
            file.write(bytes(2**20))
    except OSError as found:
        error = found
    finally:
        with suppress(OSError):
            trial.unlink()
    return f"{getattr(error, 'strerror', None) or error}; mend that and run the same command again"


def check_length(path) -> None:
    """Raise BrokenFileError if a file is not NetCDF-4, or not as long as its header states."""
    with open(path, "rb") as file:
        start = file.read(LENGTH.stop)
    if not start.startswith(SIGNATURE):
        raise BrokenFileError(f"{path} is not a NetCDF file of this project")
    stated, actual = int.from_bytes(start[LENGTH], "little"), os.path.getsize(path)
    if actual != stated and start[len(SIGNATURE) :].startswith(VERSIONS):
        raise BrokenFileError(f"{path} has {actual} bytes instead of {stated}")
