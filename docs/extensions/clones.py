"""A folder that stands for a clone of the repository in tutorials that run the workflow."""

import os
import shutil
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PARTS = ("Snakefile", "requirements.lock", "config", "profiles", "workflow")


def enter_clone():
    """Make the folder, enter it, and let the shell find Snakemake; it exists as long as the result.

    Of the package there is no copy: its kernels would be compiled anew for another path.
    """
    folder = tempfile.TemporaryDirectory()
    for part in PARTS:
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        copy(ROOT / part, Path(folder.name) / part)
    os.chdir(folder.name)
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    return folder
