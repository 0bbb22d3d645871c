"""The configurations of the project, read from their files."""

import yaml

from helpers.running import ROOT

# If the C library libyaml is installed, its parser is used: it is ten times as fast.
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


def read(path=ROOT / "config/config.yaml"):
    """Return the keys and values of a file in YAML, by default the configuration of the paper."""
    return yaml.load(path.read_bytes(), LOADER)
