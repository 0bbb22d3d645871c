"""The configurations of the project, read from their files."""

import yaml

from helpers.running import ROOT
from impact_damper.workflow.configuration import LOADER


def read(path=ROOT / "config/config.yaml"):
    """Return the keys and values of a file in YAML, by default the configuration of the paper."""
    return yaml.load(path.read_bytes(), LOADER)
