"""Kernels, compiled with numba: the equation of motion, integration steps, the search for contacts.

The compiled kernels are cached under a digest of their sources. `source_digest` stands in this
module because each dry run of Snakemake needs the digest and must not import numba.
"""

import hashlib
from importlib.metadata import version
from pathlib import Path

# Rooms (subpackages) without kernels. No file with kernels may import them, so an edit in one of
# these rooms does not change the digest.
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
