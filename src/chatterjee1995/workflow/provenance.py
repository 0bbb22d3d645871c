"""Provenance of results: versions, commit, configuration and computer."""

import hashlib
import json
import os
import platform
import re
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path


def provenance(configuration, root) -> dict:
    """Return the origin of results as a dict: versions, commit, configuration and computer."""
    root = Path(root)
    lock = (root / "requirements.lock").read_bytes()
    text = json.dumps(configuration, sort_keys=True)
    commit = _git(root, "rev-parse", "HEAD")
    changes = _git(root, "status", "--porcelain", "--untracked-files=no")
    return {
        "configuration": hashlib.sha256(text.encode()).hexdigest(),
        "lock": hashlib.sha256(lock).hexdigest(),
        "commit": commit,
        "modified": None if changes is None else bool(changes),
        "versions": {"python": platform.python_version()} | _versions(lock.decode()),
        "machine": {
            "processor": processor(),
            "cores": os.cpu_count(),
            "system": platform.platform(),
        },
    }


def processor() -> str:
    """Return the name of the processor, with family and model if the system provides them."""
    info = Path("/proc/cpuinfo")
    if not info.exists():
        return platform.processor() or platform.machine()
    lines = [line.split(":", 1) for line in info.read_text().splitlines() if ":" in line]
    entries = {key.strip(): value.strip() for key, value in reversed(lines)}
    name = entries.get("model name", platform.machine())
    return f"{name}, family {entries.get('cpu family')}, model {entries.get('model')}"


def _versions(lock):
    found = {}
    for name in ["impact-damper", *re.findall(r"^([\w.-]+)==", lock, re.MULTILINE)]:
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            continue
    return found


def _git(root, *arguments):
    command = ["git", "-C", str(root), *arguments]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return None
