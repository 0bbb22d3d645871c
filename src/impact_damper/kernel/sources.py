"""Find the source files on which a module depends, by following its imports.

A digest of these files names the folder of compiled kernels. The workflow runs a job again if a
file on which the job depends was edited. This module does not import the slow numba and NumPy.
"""

import ast
import hashlib
import re
from functools import cache
from importlib.metadata import version
from pathlib import Path

KERNEL = Path(__file__).parent
# Folder that contains this package and other packages with kernels.
ROOT = KERNEL.parents[1]


def sources(*paths) -> set:
    """Return the files `paths` and all files that they import, directly or through other files.

    Only imports from this package and from the packages of `paths` are followed.
    """
    packages = {path.relative_to(ROOT).parts[0] for path in paths if path.is_relative_to(ROOT)}
    packages = frozenset(packages | {KERNEL.parent.name})
    found, new = set(), set(paths)
    while new:
        found |= new
        new = set().union(*(_imports(path, packages) for path in new)) - found
    return found


@cache
def _imports(path, packages):
    # Only imports from `packages` are parsed, because parsing whole files takes much longer.
    statement = re.compile(
        rf"^ *((?:from|import) (?:{'|'.join(packages)})\b(?:[^(\n]*\([^)]*\)|[^(\n]*$))",
        re.MULTILINE,
    )
    names = []
    for node in ast.parse("\n".join(statement.findall(path.read_text()))).body:
        if isinstance(node, ast.Import):
            names += [alias.name for alias in node.names]
        else:
            names += [f"{node.module}.{alias.name}" for alias in node.names]
    files = set(map(module_file, names))
    # An `__init__.py` with this text imports all modules of its folder at run time.
    if path.name == "__init__.py" and "iter_modules(__path__)" in path.read_text():
        files |= set(path.parent.glob("*.py"))
    return files


@cache
def module_file(name) -> Path:
    """Return the file of the module `name`, or of the module that contains the object `name`."""
    path = ROOT.joinpath(*name.split("."))
    for place in (path, path.parent):
        for file in (place.with_suffix(".py"), place / "__init__.py"):
            if file.exists():
                return file
    raise ModuleNotFoundError(f"there is no module {name}")


@cache
def kernel_digest(*paths) -> str:
    """Return a digest of numba's version and of all files on which kernels in `paths` depend."""
    digest = hashlib.sha256(version("numba").encode())
    for path in sorted(sources(*paths, *KERNEL.rglob("*.py"))):
        name = path.relative_to(ROOT) if path.is_relative_to(ROOT) else path
        digest.update(name.as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]
