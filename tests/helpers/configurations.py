"""The configurations of the project, read from their files."""

import copy

import pytest
import yaml
from snakemake.utils import update_config

from chatterjee1995.sections.configuration import configuration, without_left_out
from helpers.running import ROOT
from impact_damper.command.section import LOADER, ConfigurationError


def read(path=ROOT / "config/config.yaml"):
    """Return the keys and values of a file in YAML, by default the configuration of the paper."""
    return yaml.load(path.read_bytes(), LOADER)


def paper():
    """Return the configuration of the paper as an object."""
    return configuration(read(), trusted=True)


def small():
    """Return the configuration of the smoke run, which has one or two entries in each section."""
    config = read()
    update_config(config, read(ROOT / "config/smoke.yaml"))
    return without_left_out(config)


def changed(config, path, value):
    """Return a configuration with another value at a path of keys and places."""
    config = parent = copy.copy(config)
    for key in path[:-1]:
        parent[key] = parent = copy.copy(parent[key])
    parent[path[-1]] = value
    return config


def problems(config):
    """Return the lines with which a configuration is refused."""
    with pytest.raises(ConfigurationError) as caught:
        configuration(config)
    return str(caught.value).splitlines()
