"""Archive of a run: `python workflow/archive.py write FILE`, and `check FILE`.

The archive is a zip file with the results, and with all files needed to compute them again. Its
metadata (an RO-Crate) list digests and jobs. The check compares digests and runs a job again.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
import zipfile
from pathlib import Path
from urllib.parse import unquote

from crate import METADATA, crate, encoded, sha256

# Files and folders that a rerun needs beside the results.
PROJECT = "CITATION.cff CONTRIBUTING.md LICENSE Makefile README.md Snakefile codemeta.json".split()
PROJECT += "config profiles pyproject.toml requirements.lock src workflow".split()
LEFT_OUT = "__pycache__", ".egg-info", ".part-"


def listed(root, results):
    """Return the paths of all files of the archive, relative to the root."""
    tops = [root / name for name in (*PROJECT, results) if (root / name).exists()]
    paths = [path for top in tops for path in (top.rglob("*") if top.is_dir() else [top])]
    names = [path.relative_to(root).as_posix() for path in paths if path.is_file()]
    return sorted(name for name in names if not any(part in name for part in LEFT_OUT))


def write(root, archive, results):
    """Write the archive of the project in the folder `root` with its results."""
    paths = listed(root, results)
    try:
        metadata, count = crate(root, results, paths)
    except ValueError as error:
        sys.exit(f"No archive is written: {error}.")
    with zipfile.ZipFile(archive, "w", zipfile.ZIP_DEFLATED) as file:
        file.writestr(METADATA, json.dumps(metadata, indent=1))
        for path in paths:
            file.write(root / path, path)
    print(f"{archive}: {len(paths)} files, {count} jobs")


def check(archive, job):
    """Compare the digests of all files of an archive, and run one of its jobs again."""
    with tempfile.TemporaryDirectory() as folder:
        with zipfile.ZipFile(archive) as file:
            file.extractall(folder)
        root = Path(folder)
        graph = json.loads((root / METADATA).read_text())["@graph"]
        digests = {unquote(each["@id"]): each["sha256"] for each in graph if "sha256" in each}
        present = {each.relative_to(root).as_posix() for each in root.rglob("*") if each.is_file()}
        wrong = digests.keys() ^ (present - {METADATA})
        wrong |= {path for path in digests.keys() & present if sha256(root / path) != digests[path]}
        if wrong:
            sys.exit(f"{archive}: damaged, lacking or not listed: {', '.join(sorted(wrong))}.")
        print(f"{archive}: {len(digests)} files have the digests of the crate")
        rerun(root, {each["@id"]: each for each in graph}, job)


def names(linked):
    """Return the names that a link of the RO-Crate, or a list of links, refers to."""
    return [unquote(each["@id"]) for each in (linked if isinstance(linked, list) else [linked])]


def cheapest(entities):
    """Return the name of the shortest job that reads no dataset and writes a dataset."""

    def has_datasets(action, key):
        return any(name.endswith(".nc") for name in names(action[key]))

    def seconds(action):
        return float(entities[f"{action['@id']}/seconds"]["value"])

    jobs = [each for each in entities.values() if "resourceUsage" in each]
    alone = [
        each for each in jobs if has_datasets(each, "result") and not has_datasets(each, "object")
    ]
    return min(alone, key=seconds)["@id"].removeprefix("#")


def rerun(root, entities, job):
    """Delete the outputs of a job, run it from the files of the archive, and compare digests."""
    job = job or cheapest(entities)
    outputs = names(entities[f"#{job}"]["result"])
    for path in outputs:
        (root / path).unlink()
    command = [sys.executable, "-m", "snakemake", "--cores", "1", "--rerun-triggers", "input"]
    environment = os.environ | {"PYTHONPATH": str(root / "src")}
    subprocess.run([*command, "--", *outputs], cwd=root, env=environment, check=True)
    other = [path for path in outputs if sha256(root / path) != entities[encoded(path)]["sha256"]]
    if other:
        sys.exit(f"The job {job} run again writes other bytes: {', '.join(other)}.")
    print(f"The job {job} run again writes the same bytes: {', '.join(outputs)}")


def main():
    """Read the arguments, and write or check an archive."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("what", choices=["write", "check"])
    parser.add_argument("archive", type=Path)
    parser.add_argument("--results", default="results", help="folder of the results")
    parser.add_argument("--job", help="job to run again; otherwise the shortest one")
    given = parser.parse_args()
    if given.what == "write":
        write(Path.cwd(), given.archive, given.results)
    else:
        check(given.archive, given.job)


if __name__ == "__main__":
    main()
