"""A temporary copy of the repository for tutorials that run the workflow."""

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
    """Make the folder, change to it, and let the shell find Snakemake.

    The folder is deleted together with the object returned. It has no copy of the package, whose
    kernels would be compiled again for another path.
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

    IPython's own `%%bash` prints its output in pieces, and the pages would break lines between
    them.
    """
    ran = subprocess.run(["bash", "-c", cell], capture_output=True, text=True)
    print(ran.stdout, end="")
    if ran.returncode:
        print(ran.stderr, file=sys.stderr)
        ran.check_returncode()
