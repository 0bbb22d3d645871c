"""Computer and versions with which times were measured."""

import os
import platform
from importlib.metadata import version

import pandas as pd

from chatterjee1995.tables import files as table_files
from chatterjee1995.workflow.provenance import processor

PACKAGES = ("numba", "llvmlite", "numpy", "scipy", "heyoka")


def table():
    """Return processor, system and versions, a row for each."""
    rows = {
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "system": platform.system(),
        "python": platform.python_version(),
    } | {name: version(name) for name in PACKAGES}
    return pd.DataFrame({"item": rows.keys(), "value": rows.values()})


def document(how=""):
    """Return a function from a table to Markdown: the computer, the text `how`, and the table."""
    described = ", ".join(f"{row.item} {row.value}" for row in table().itertuples())
    made = f"Made by `make benchmark` on: {described}."
    return lambda shown: "\n\n".join(filter(None, [made, how, table_files.as_markdown(shown)]))
