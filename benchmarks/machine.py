"""What the times were measured on."""

import os
import platform
from importlib.metadata import version

import pandas as pd

from impact_damper.provenance import processor

PACKAGES = ("numba", "llvmlite", "numpy", "scipy", "heyoka")


def table():
    """Machine and versions."""
    rows = {
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "system": platform.system(),
        "python": platform.python_version(),
    } | {name: version(name) for name in PACKAGES}
    return pd.DataFrame({"item": rows.keys(), "value": rows.values()})
