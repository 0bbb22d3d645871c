"""Kernels, compiled with numba: the equation of motion, steps, the search for contacts.

The digest of their sources stands here because each dry run needs it and must not import numba.
"""

import hashlib
from importlib.metadata import version
from pathlib import Path

# These rooms hold no kernels, and no file with kernels may import them.
ROOMS_WITHOUT_KERNELS = (
    "data",
    "machine",
    "theory",
    "literature",
    "absorbers",
    "orbits",
    "edges",
    "comparisons",
    "performance",
    "design",
    "stages",
    "claims",
    "tables",
    "figures",
    "pages",
    "workflow",
)


def source_digest() -> str:
    """Return the digest of numba's version and of the sources that kernels can depend on."""
    digest = hashlib.sha256(version("numba").encode())
    package = Path(__file__).parents[1]
    for path in sorted(package.rglob("*.py")):
        name = path.relative_to(package)
        if name.parts[0] not in ROOMS_WITHOUT_KERNELS:
            digest.update(name.as_posix().encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:16]
