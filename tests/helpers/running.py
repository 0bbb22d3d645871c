"""Runs of Snakemake on copies of the project."""

import os
import shutil
import subprocess
import sys
from contextlib import contextmanager
from pathlib import Path

ROOT = Path(__file__).parents[2]
PARTS = ["Snakefile", "requirements.lock", "config", "profiles", "workflow", "src"]


def snakemake(project, *arguments, **options):
    """Run Snakemake in the folder of a project, with the package in this folder."""
    environment = os.environ | {"PYTHONPATH": str(project / "src")} | options.pop("env", {})
    command = [sys.executable, "-m", "snakemake", "--cores", "2", *arguments]
    options = {"cwd": project, "env": environment, "capture_output": True, "text": True} | options
    return subprocess.run(command, check=False, **options)


def copy_of_project(folder):
    """Copy all files that a run needs to a folder, and return the folder."""
    for part in PARTS:
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        copy(ROOT / part, folder / part)
    return folder


@contextmanager
def edits(folder):
    """Yield a function that edits a file of a folder, and restore all files at the end."""
    originals = {}

    def change(name, edited):
        path = folder / name
        originals[path] = path.read_text()
        path.write_text(edited(originals[path]))

    yield change
    for path, text in originals.items():
        path.write_text(text)
