"""Chapter of the report: optimum clearance.

A function with the name of a stage returns the parameters of its job for an entry of the
configuration.
"""

import math

from chatterjee1995.variables.studies import AXES
from chatterjee1995.workflow.registry.records import PANELS, Kind, Stage, Table
from chatterjee1995.workflow.registry.values import (
    axis,
    grid,
    oscillator,
    search,
    settling,
    system,
)


def optimum(config, name):
    entry = config["optimum"][name]
    starts = {"starts": entry["starts"]} if "starts" in entry else {}
    return system(config, entry) | {
        "frequency": entry["frequency"],
        "clearances": grid(entry["clearances"], config["points"]["clearances"]),
        "search": search(config, "sweep_starts") | starts,
        "settling": settling(config),
    }


def design_rules(config, name):
    entry = config["design_rules"][name]
    axes = ("mass_ratios", "restitutions", "contact_stiffnesses", "frequencies")
    return {
        "oscillator": oscillator(config, entry["oscillator"]),
        "grid": [entry[key] for key in axes],
    }


def studies(config, name):
    entry = config["studies"][name]
    axes = {key: axis(entry[key]) for key in AXES}
    return {
        "oscillator": oscillator(config, entry["oscillator"]),
        "axes": axes,
        "cells": [0, math.prod(points for _, _, points in axes.values())],
        "contact_stiffness": config["contact_stiffness"],
        "search": search(config, "study_starts"),
        "settling": settling(config),
    }


def study_chunk(config, name, chunk):
    """Return the parameters of `studies` and the cells of a chunk, such as "2-of-4"."""
    given = studies(config, name)
    number, count = map(int, chunk.split("-of-"))
    _, cells = given["cells"]
    return given | {"cells": [cells * (number - 1) // count, cells * number // count]}


TITLE = "Optimum clearance"
STAGES = (
    Stage("optimum", "optimum", optimum),
    Stage("design_rules", "design_rules", design_rules),
    Stage("studies", "studies", studies),
)
KINDS = (
    Kind("optimum", ("optimum",), PANELS.format("optimum")),
    Kind("clearance_shares", ("optimum",), module=PANELS.format("shares")),
    Kind("design_rules", ("design_rules",), named=True),
    Kind("studies", ("studies",), most=1),
)
TABLES = (
    Table(
        "optimum",
        "chatterjee1995.tables.clearance",
        ("optimum",),
        "Optimum clearances by simulation, by equations (7) and by rules (18), (19) of the paper.",
    ),
    Table(
        "design_rules",
        "chatterjee1995.tables.clearance",
        ("design_rules", "optimum"),
        "Number of optima that each rule for the clearance predicts within a few per cent.",
    ),
)
