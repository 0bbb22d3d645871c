"""Files that appear only when they are whole, and damage that can be seen without reading them."""

import glob
import os
from contextlib import contextmanager, suppress
from pathlib import Path

DELETE = "delete it and run the same command again"

# How an HDF5 file begins, and where its length stands in the versions of its first block that
# follow.
SIGNATURE = b"\x89HDF\r\n\x1a\n"
VERSIONS = (b"\x02\x08\x08", b"\x03\x08\x08")
LENGTH = slice(28, 36)


class BrokenFileError(OSError):
    """A result that is not what a run has written; the message says what to do."""


@contextmanager
def whole(path):
    """Path to write to; the file gets its name `path` once it is written to the end.

    What a killed process has left of the same file is removed first.

    Raises
    ------
    OSError
        If the file cannot be written, with its path and the reason.
    """
    path = Path(path)
    part = path.with_name(f"{path.name}.part-{os.getpid()}")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        for left in path.parent.glob(f"{glob.escape(path.name)}.part-*"):
            left.unlink(missing_ok=True)
        yield part
        os.replace(part, path)
    except BrokenFileError:
        raise  # of another file, that was read for this one
    except OSError as error:
        raise OSError(f"{path} cannot be written: {_reason(path.parent, error)}") from error
    finally:
        with suppress(OSError):
            part.unlink()


@contextmanager
def whole_netcdf(path):
    """`whole` for a NetCDF file, which is looked at before it gets its name."""
    with whole(path) as part:
        try:
            yield part
        except RuntimeError as error:  # the NetCDF library's own
            raise OSError(str(error)) from error
        check_length(part)


def _reason(folder, error):
    """Why a file could not be written: NetCDF says little, and of a full disk the wrong thing."""
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
    """Raise if a NetCDF file is not of the kind that a run writes, or is cut off.

    Only its first bytes are read, so that all results can be looked at before a run.

    Raises
    ------
    BrokenFileError
        Naming the file and what to do.
    """
    with open(path, "rb") as file:
        start = file.read(LENGTH.stop)
    if not start.startswith(SIGNATURE):
        raise BrokenFileError(f"{path} is not a NetCDF file of this project: {DELETE}.")
    stated, found = int.from_bytes(start[LENGTH], "little"), os.path.getsize(path)
    if found != stated and start[len(SIGNATURE) :].startswith(VERSIONS):
        raise BrokenFileError(f"{path} has {found} bytes in place of {stated}: {DELETE}.")
