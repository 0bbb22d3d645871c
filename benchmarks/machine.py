"""What the times were measured on."""

import os
import platform
from importlib.metadata import version

import pandas as pd

from impact_damper.data import table_files
from impact_damper.workflow.provenance import processor

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


def document(how=""):
    """What makes the Markdown of a table: made on what, how it was measured, and the numbers."""
    described = ", ".join(f"{row.item} {row.value}" for row in table().itertuples())
    made = f"Made by `make benchmark` on: {described}."
    return lambda shown: "\n\n".join(filter(None, [made, how, table_files.plain(shown)]))
