"""A temporary copy of the workflow's files for tutorials that run the workflow."""

import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from IPython import get_ipython

ROOT = Path(__file__).resolve().parents[2]
PARTS = ("Snakefile", "requirements.lock", "config", "profiles", "workflow")


def enter_clone():
    """Copy the workflow's files to a temporary folder, change to it, and return the folder object.

    The folder is deleted together with the object. Afterwards the shell finds Snakemake, and
    `%%bash` runs the function `bash`. The package is not copied, because its kernels (functions
    compiled by numba) would be compiled again for another path.
    """
    folder = tempfile.TemporaryDirectory()
    for part in PARTS:
        copy = shutil.copytree if (ROOT / part).is_dir() else shutil.copy
        copy(ROOT / part, Path(folder.name) / part)
    os.chdir(folder.name)
    os.environ["PATH"] = os.pathsep.join([str(Path(sys.executable).parent), os.environ["PATH"]])
    get_ipython().register_magic_function(bash, "cell")
    return folder


def bash(line, cell):
    """Run the cell in a shell and print its output in one piece.

    IPython's own `%%bash` prints the output in pieces, and the pages would break lines between the
    pieces.
    """
    ran = subprocess.run(["bash", "-c", cell], capture_output=True, text=True)
    print(ran.stdout, end="")
    if ran.returncode:
        print(ran.stderr, file=sys.stderr)
        ran.check_returncode()
