"""Source files of a job: its script, and every module of the package that the script imports.

The files are inputs of the job, so that Snakemake compares their contents. Kernels are functions
compiled by numba; a marker file holds a digest of their sources.
"""

import ast
import re
from functools import cache
from pathlib import Path

from impact_damper.kernel import source_digest

PACKAGE = Path(__file__).parents[1]

# Statement that imports from the package. Parsing only these statements, not whole files, saves
# half a second in a dry run.
IMPORT = re.compile(
    rf"^ *((?:from|import) {PACKAGE.name}\b(?:[^(\n]*\([^)]*\)|[^(\n]*$))", re.MULTILINE
)


def sources(*paths) -> set:
    """Return the given files, and all files of the package that they import, directly or not."""
    found, new = set(), set(paths)
    while new:
        found |= new
        new = set().union(*map(_imports, new)) - found
    return found


@cache
def _imports(path):
    """Return the files of the package that a Python file imports directly.

    The `__init__.py` of a subpackage is included only if a name is imported from it. Python always
    executes this file, but it does not affect results otherwise.
    """
    statements = ast.parse("\n".join(IMPORT.findall(path.read_text()))).body
    names = []
    for node in statements:
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        else:
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    return {module_file(name.partition(".")[2]) for name in names}


@cache
def module_file(name) -> Path:
    """Return the file of a module, or of the module from which a name is imported.

    Raises
    ------
    ModuleNotFoundError
        If there is no such module.
    """
    path = PACKAGE.joinpath(*name.split("."))
    for place in (path, path.parent):
        for file in (place.with_suffix(".py"), place / "__init__.py"):
            if file.exists():
                return file
    raise ModuleNotFoundError(f"there is no module {PACKAGE.name}.{name}")


def compiled_kernels(config) -> str:
    """Return the text of the marker file: digest of the sources, and orders of Taylor series."""
    return f"{source_digest()} {config['comparison']['orders']}\n"
