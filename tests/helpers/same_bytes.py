"""Compare the results of two runs byte by byte.

    PYTHONPATH=src:tests python -m helpers.same_bytes [config/smoke.yaml]

The first run uses one core. The second run uses two cores, in a folder whose name has a space. All
files of the results are compared, except files about the run (`OF_THE_RUN`), such as logs.
"""

import hashlib
import shutil
import sys
import tempfile
from pathlib import Path

import yaml

from helpers.running import copy_of_project, snakemake

# Files about the run: logs, times and the computer.
OF_THE_RUN = ("logs", "timings", "benchmarks", "provenance.json")


def digests(results):
    """Return the digest of each file of the results that must not differ, by path."""
    return {
        path.relative_to(results).as_posix(): hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(results.rglob("*"))
        if path.is_file() and path.relative_to(results).parts[0] not in OF_THE_RUN
    }


def run(project, cores, chosen):
    """Run a copy of the project on a number of cores; return the digests of its results."""
    copy_of_project(project)
    arguments = ["everything", "--cores", str(cores)]
    arguments += ["--configfile", chosen] if chosen else []
    ended = snakemake(project, *arguments, capture_output=False)
    if ended.returncode:
        sys.exit(f"The run on {cores} cores in {project} failed; its messages are above.")
    files = ["config/config.yaml", *([chosen] if chosen else [])]
    results = [yaml.safe_load((project / file).read_text()).get("results") for file in files]
    return digests(project / next(filter(None, reversed(results))))


def main(chosen=None):
    folder = Path(tempfile.mkdtemp(prefix="same-bytes-"))
    try:
        one = run(_made(folder / "one"), 1, chosen)
        two = run(_made(folder / "two cores"), 2, chosen)
    finally:
        shutil.rmtree(folder)
    differing = sorted(path for path in one.keys() | two.keys() if one.get(path) != two.get(path))
    kinds = sorted({Path(path).suffix for path in one})
    print("| kind | files | that differ |\n|---|---|---|")
    for kind in kinds:
        count = sum(path.endswith(kind) for path in one)
        print(f"| {kind} | {count} | {sum(path.endswith(kind) for path in differing)} |")
    if differing:
        sys.exit("Not the same bytes: " + ", ".join(differing))
    print(f"All {len(one)} files are the same, byte for byte.")


def _made(folder):
    """Make a folder and return its path."""
    folder.mkdir()
    return folder


if __name__ == "__main__":
    main(*sys.argv[1:])
