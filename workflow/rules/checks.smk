"""Results that no run has left like this: told, or mended, before anything is planned."""

import tempfile
import time

from impact_damper.whole_files import check_length


def check_results(folder):
    """Refuse data that are cut off, and see to it that an edit cannot be older than a result.

    Snakemake looks at the contents of a file only where it is newer than what was made of it. A
    result with a date in the future, from before the clock was set back, would hide every edit
    since: it gets the oldest date, so that contents decide.
    """
    now, ahead = time.time(), []
    for path in folder.rglob("*"):
        if path.is_file() and path.stat().st_mtime > now:
            ahead.append(path)
    for path in ahead:
        os.utime(path, (0, 0))
    if ahead:
        logger.warning(
            f"{len(ahead)} files in {folder} had dates in the future, as {ahead[0]}, for the clock "
            "was set back. They are now dated 1970, and contents decide what runs again."
        )
    try:
        for path in sorted(folder.glob("*/*.nc")):
            check_length(path)
    except OSError as error:
        raise WorkflowError(str(error)) from None


check_results(Path(config["results"]))


onstart:
    try:
        os.makedirs(config["results"], exist_ok=True)
        with tempfile.TemporaryFile(dir=config["results"]) as file:
            file.write(b"a trial")
            file.flush()
    except OSError as error:
        raise WorkflowError(
            f"Nothing can be written to the folder {config['results']} ({error.strerror}): mend "
            "that, or name another folder under `results:` in the configuration."
        ) from None
