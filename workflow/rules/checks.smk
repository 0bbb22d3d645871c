"""Checks of the folder of results before anything is planned: damage, dates, permissions."""

import time
from contextlib import suppress

from impact_damper.data.whole_files import DELETE, BrokenFileError, check_length

# Seconds by which clocks of computers that share a disk may differ.
SKEW = 10
# The first second of 1970. Snakemake takes 0 for a missing date.
OLDEST = 1


def check_results(folder):
    """Raise if a dataset is truncated, and set dates in the future to OLDEST.

    Snakemake compares the contents of an input only if the input is newer than the output. After
    the clock was set back, outputs have dates in the future, and later edits of inputs would be
    overlooked. With outputs of the date OLDEST, Snakemake compares the contents of all inputs.
    """
    ahead = []
    try:
        for path in sorted(folder.rglob("*")):
            with suppress(FileNotFoundError):  # another run may remove files
                if path.suffix == ".nc":
                    check_length(path)
                if path.is_file() and path.stat().st_mtime > time.time() + SKEW:
                    os.utime(path, (OLDEST, OLDEST))
                    ahead.append(path)
    except BrokenFileError as error:
        raise WorkflowError(f"{error}: {DELETE}.") from None
    except OSError as error:
        raise WorkflowError(str(error)) from None
    if ahead:
        logger.warning(
            f"{len(ahead)} files in {folder} have dates in the future, such as {ahead[0]}: the "
            "clock was set back. They are now dated 1970, so that contents decide which jobs run."
        )


def unwritable(folder):
    """Return advice if a folder has no write permission, otherwise an empty text."""
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if os.access(there, os.W_OK):
        return ""
    return (
        f"Nothing can be written to the folder {folder}: make it writable, or name another folder "
        "under `results:` in the configuration."
    )


def check_writable(folder):
    """Raise a WorkflowError if the folder has no write permission."""
    if words := unwritable(folder):
        raise WorkflowError(words)


# Only the main process checks; jobs run in other processes.
if workflow.is_main_process:
    check_results(Path(settings.results))
# A warning only, because a dry run or a finished run writes nothing; `check_writable` raises later.
if words := unwritable(Path(settings.results)):
    logger.warning(words)
