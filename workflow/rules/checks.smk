"""Results that no run has left like this: told, or mended, before anything is planned."""

import time
from contextlib import suppress

from impact_damper.data.whole_files import check_length

# Seconds by which clocks of machines that share a disk may differ.
SKEW = 10
# The first second of 1970; Snakemake takes a date of 0 for none.
OLDEST = 1


def check_results(folder):
    """Refuse data that are cut off, and see to it that an edit cannot be older than a result.

    Snakemake looks at the contents of a file only where it is newer than what was made of it. A
    result with a date in the future, from before the clock was set back, would hide every edit
    since: it gets the oldest date, so that contents decide.
    """
    ahead = []
    try:
        for path in sorted(folder.rglob("*")):
            with suppress(FileNotFoundError):  # another run may take files away
                if path.suffix == ".nc":
                    check_length(path)
                if path.is_file() and path.stat().st_mtime > time.time() + SKEW:
                    os.utime(path, (OLDEST, OLDEST))
                    ahead.append(path)
    except OSError as error:
        raise WorkflowError(str(error)) from None
    if ahead:
        logger.warning(
            f"{len(ahead)} files in {folder} had dates in the future, as {ahead[0]}, for the clock "
            "was set back. They are now dated 1970, and contents decide what runs again."
        )


def unwritable(folder):
    """What to do about a folder that cannot be written to; nothing if it can."""
    there = next(path for path in (folder, *folder.absolute().parents) if path.exists())
    if os.access(there, os.W_OK):
        return ""
    return (
        f"Nothing can be written to the folder {folder}: make it writable, or name another folder "
        "under `results:` in the configuration."
    )


def check_writable(folder):
    """Refuse to start jobs where nothing can be written."""
    if words := unwritable(folder):
        raise WorkflowError(words)


# Not once more in each job.
if workflow.is_main_process:
    check_results(Path(config["results"]))
# What is there can still be looked at; Snakemake's own words for a run that would write come later.
if words := unwritable(Path(config["results"])):
    logger.warning(words)
