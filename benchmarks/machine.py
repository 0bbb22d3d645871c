"""What the times were measured on."""

import os
import platform
from importlib.metadata import version
from pathlib import Path

import pandas as pd

PACKAGES = ("numba", "llvmlite", "numpy", "scipy", "heyoka")


def processor():
    """The processor's name, with family and model where the system tells."""
    info = Path("/proc/cpuinfo")
    if not info.exists():
        return platform.processor() or platform.machine()
    lines = [line.split(":", 1) for line in info.read_text().splitlines() if ":" in line]
    entries = {key.strip(): value.strip() for key, value in reversed(lines)}
    name = entries.get("model name", platform.machine())
    return f"{name}, family {entries.get('cpu family')}, model {entries.get('model')}"


def table():
    """Machine and versions."""
    rows = {
        "processor": processor(),
        "cores": str(os.cpu_count()),
        "system": platform.system(),
        "python": platform.python_version(),
    } | {name: version(name) for name in PACKAGES}
    return pd.DataFrame({"item": rows.keys(), "value": rows.values()})
