"""Chapter of the report: migration control, from one motion to another by switching the damper.

A function with the name of a stage returns the parameters of its job for an entry of the
configuration.
"""

from chatterjee1995.workflow.registry.records import PANELS, Kind, Stage, Table
from chatterjee1995.workflow.registry.values import (
    damper,
    grid,
    oscillator,
    search,
    settling,
    system,
)


def migration(config, name):
    entry = config["migration"][name]
    return system(config, entry) | {
        "frequency": entry["frequency"],
        "controller": config["controller"] | {"longest_hold": entry["longest_hold"]},
        "seed": config["seed"],
        "settling": settling(config),
    }


def release_scan(config, name):
    entry = config["release_scan"][name]
    return system(config, entry) | {
        "frequencies": grid(entry["frequencies"], config["points"]["scanned"]),
        "search": search(config, "scan_starts"),
        "releases": config["controller"]["releases"],
        "lifetime": entry["lifetime"],
        "settling": settling(config),
    }


def basins(config, name):
    entry = config["basins"][name]
    return system(config, entry) | {
        "frequency": entry["frequency"],
        "plane": {key: entry[key] for key in ("displacement", "velocity", "cells")},
        "settling": settling(config),
    }


def release_policies(config, name):
    entry = config["release_policies"][name]
    keys = ("frequencies", "trials", "tested", "cells")
    return {
        "oscillator": oscillator(config, entry["oscillator"]),
        "dampers": [damper(config, each) for _, each in sorted(entry["dampers"].items())],
        "policies": {key: entry[key] for key in keys} | {"seed": config["seed"]},
        "settling": settling(config),
    }


TITLE = "Migration control"
STAGES = (
    Stage("migration", "migration", migration),
    Stage("release_scan", "release_scan", release_scan),
    Stage("basins", "basins", basins),
    Stage("release_policies", "release_policies", release_policies),
)
KINDS = (
    Kind("migration", ("migration",), PANELS.format("migration")),
    Kind("release", ("migration",)),
    Kind("basins", ("basins",), PANELS.format("basins"), damper=False, most=4),
    Kind("release_policies", ("release_policies",), most=1),
)
TABLES = (
    Table(
        "migration",
        "chatterjee1995.tables.migration",
        ("migration",),
        "Destinations of releases, and outcomes, switchings and times of migration control.",
    ),
    Table(
        "release_scan",
        "chatterjee1995.tables.migration",
        ("release_scan",),
        "Frequencies at which releases of each damped motion lead to each free motion.",
    ),
    Table(
        "release_policies",
        "chatterjee1995.tables.policies",
        ("release_policies",),
        "When to switch the damper off: success and cycles of each policy.",
    ),
)
